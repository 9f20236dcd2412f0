#include "particles/walls/stl_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.hpp"

namespace silt {
namespace {

constexpr std::size_t header_bytes = 84, facet_bytes = 50;

std::vector<StlFacet> read_binary(const std::string& bytes, std::size_t count) {
  std::vector<StlFacet> facets(count);
  for (std::size_t f = 0; f < count; ++f) {
    float numbers[12];
    std::memcpy(numbers, bytes.data() + header_bytes + facet_bytes * f, sizeof numbers);
    for (int d = 0; d < 3; ++d) {
      facets[f].normal[d] = numbers[d];
      for (int k = 0; k < 3; ++k) facets[f].corner[k][d] = numbers[3 + 3 * k + d];
    }
  }
  return facets;
}

/// Reads word by word, knowing the line it is on.
class Words {
 public:
  Words(const std::string& text, const std::string& file) : text_(text), file_(file) {}
  /// The next word, in small letters; empty at the end.
  std::string next() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) line_ += text_[at_++] == '\n';
    std::string word;
    while (at_ < text_.size() && !std::isspace(static_cast<unsigned char>(text_[at_])))
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(text_[at_++])));
    return word;
  }
  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  }
  void expect(const char* word) {
    if (const std::string found = next(); found != word) refuse(found, word);
  }
  Vec3 numbers() {
    Vec3 result;
    for (int d = 0; d < 3; ++d) {
      const std::string word = next();
      char* end = nullptr;
      result[d] = std::strtod(word.c_str(), &end);
      if (word.empty() || *end != 0) refuse(word, "a number");
    }
    return result;
  }
  [[noreturn]] void refuse(const std::string& found, const std::string& wanted) const {
    throw UserError(fmt::format("{}:{}: '{}' where {} is expected in an ASCII STL file", file_, line_,
                                found.substr(0, 40), wanted));
  }

 private:
  const std::string& text_;
  const std::string& file_;
  std::size_t at_ = 0;
  int line_ = 1;
};

std::vector<StlFacet> read_ascii(const std::string& text, const std::string& file) {
  Words words(text, file);
  std::vector<StlFacet> facets;
  words.expect("solid");
  words.skip_line();
  for (;;) {
    const std::string word = words.next();
    if (word == "endsolid") {
      words.skip_line();
      if (words.next().empty()) break;  // a file may hold several solids
      words.skip_line();
      continue;
    }
    if (word != "facet") words.refuse(word, "facet or endsolid");
    StlFacet facet;
    words.expect("normal");
    facet.normal = words.numbers();
    words.expect("outer");
    words.expect("loop");
    for (Vec3& corner : facet.corner) {
      words.expect("vertex");
      corner = words.numbers();
    }
    words.expect("endloop");
    words.expect("endfacet");
    facets.push_back(facet);
  }
  return facets;
}

}  // namespace

std::vector<StlFacet> read_stl(const std::string& file) {
  if (!std::filesystem::is_regular_file(file)) throw UserError(fmt::format("'{}' does not exist", file));
  std::ifstream stream(file, std::ios::binary);
  std::stringstream buffer;
  buffer << stream.rdbuf();
  const std::string bytes = buffer.str();
  std::uint32_t count = 0;
  if (bytes.size() >= header_bytes) std::memcpy(&count, bytes.data() + 80, sizeof count);
  const bool binary = bytes.size() >= header_bytes && bytes.size() == header_bytes + facet_bytes * std::size_t{count};
  std::vector<StlFacet> facets;
  if (binary) {
    facets = read_binary(bytes, count);
  } else if (bytes.compare(0, 5, "solid") == 0) {
    facets = read_ascii(bytes, file);
  } else if (bytes.size() >= header_bytes) {
    throw UserError(fmt::format("{}: no STL file: it has {} bytes, {} facets as its header says would need {}", file,
                                bytes.size(), count, header_bytes + facet_bytes * std::size_t{count}));
  } else {
    throw UserError(fmt::format("{}: no STL file", file));
  }
  if (facets.empty()) throw UserError(fmt::format("{}: the STL file has no facets", file));
  return facets;
}

}  // namespace silt

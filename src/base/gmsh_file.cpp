#include "base/gmsh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>
#include <vector>

namespace silt {
namespace {

struct Fault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The numbers and words of a file one after the other; what is not there is a Fault.
class Scanner {
 public:
  explicit Scanner(std::string text) : text_(std::move(text)) {}

  bool binary = false;

  [[noreturn]] void fail(const std::string& what) const {
    const auto end = text_.begin() + static_cast<long>(std::min(at_, text_.size()));
    throw Fault(binary ? fmt::format("byte {}: {}", at_, what)
                       : fmt::format("line {}: {}", 1 + std::count(text_.begin(), end, '\n'), what));
  }
  bool at_end() {
    skip_blanks();
    return at_ == text_.size();
  }
  /// The rest of the line.
  std::string line() {
    const size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string result = text_.substr(at_, end - at_);
    at_ = std::min(end + 1, text_.size());
    while (!result.empty() && std::isspace(static_cast<unsigned char>(result.back()))) result.pop_back();
    return result;
  }
  std::string word() {
    skip_blanks();
    const size_t start = at_;
    while (at_ < text_.size() && !std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    return text_.substr(start, at_ - start);
  }
  bool next_is(const std::string& mark) {
    skip_blanks();
    return text_.compare(at_, mark.size(), mark) == 0;
  }
  void expect(const std::string& mark) {
    if (word() != mark) fail(mark + " is missing");
  }
  void skip_past(const std::string& mark) {
    const size_t found = text_.find(mark, at_);
    if (found == std::string::npos) fail(mark + " is missing");
    at_ = found + mark.size();
  }
  long long written() { return read<long long>("a whole number"); }
  long long integer() { return binary ? raw<std::int32_t>() : written(); }
  /// A number that takes 8 bytes in format 4.1.
  long long size() { return binary ? raw<std::int64_t>() : written(); }
  double real() {
    const double value = binary ? raw<double>() : read<double>("a number");
    if (!std::isfinite(value)) fail("a coordinate that is no number");
    return value;
  }
  /// A number of things of which each takes so many bytes at least.
  size_t count(long long number, const char* what, int bytes_each) const {
    if (number < 0 || static_cast<unsigned long long>(number) > (text_.size() - at_) / static_cast<size_t>(bytes_each))
      fail(fmt::format("{} {} are said to follow, more than there can be", number, what));
    return static_cast<size_t>(number);
  }
  void end_line() {
    if (binary && at_ < text_.size() && text_[at_] == '\n') ++at_;
  }

 private:
  void skip_blanks() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }
  template <class T>
  T read(const char* what) {
    skip_blanks();
    T value{};
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc() || (end != text_.data() + text_.size() && !std::isspace(static_cast<unsigned char>(*end))))
      fail(fmt::format("{} is missing", what));
    at_ = static_cast<size_t>(end - text_.data());
    return value;
  }
  template <class T>
  T raw() {
    if (text_.size() - at_ < sizeof(T)) fail("the file ends");
    T value;
    std::memcpy(&value, text_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }

  std::string text_;
  size_t at_ = 0;
};

/// Goes through a file and throws a Fault for what is wrong.
class Check {
 public:
  explicit Check(std::string text) : scan_(std::move(text)) {}

  void all() {
    header();
    bool has_elements = false;
    while (!scan_.at_end()) {
      const std::string mark = scan_.word();
      if (mark.size() < 2 || mark[0] != '$') scan_.fail("a section is expected");
      if (mark == "$PhysicalNames") {
        names();
      } else if (mark == "$Entities" && newer_) {
        scan_.end_line();
        entities();
      } else if (mark == "$Nodes") {
        nodes();
      } else if (mark == "$Elements") {
        elements();
        has_elements = true;
      } else if (mark == "$Periodic") {
        periodic();
      } else {
        scan_.skip_past("$End" + mark.substr(1));
        continue;
      }
      scan_.expect("$End" + mark.substr(1));
    }
    if (!has_elements) scan_.fail("there are no elements");
  }

 private:
  void header() {
    scan_.expect("$MeshFormat");
    const std::string version = scan_.word();
    if (version != "2.2" && version != "4.1") scan_.fail(fmt::format("format '{}' is neither 2.2 nor 4.1", version));
    newer_ = version == "4.1";
    const long long kind = scan_.written(), bytes = scan_.written();
    if (kind < 0 || kind > 1 || bytes != 8) scan_.fail("numbers of 8 bytes are expected, as text (0) or binary (1)");
    scan_.line();
    scan_.binary = kind == 1;
    if (scan_.binary && scan_.integer() != 1) scan_.fail("written by a machine of another order of bytes");
    scan_.expect("$EndMeshFormat");
  }

  void names() {
    const size_t number = scan_.count(scan_.written(), "names", 4);
    scan_.line();
    for (size_t k = 0; k < number; ++k) {
      const std::string line = scan_.line();
      int dimension = 0, tag = 0, used = 0;
      if (std::sscanf(line.c_str(), "%d %d \"%n", &dimension, &tag, &used) < 2 || used == 0 || line.back() != '"' ||
          line.size() > 120 || dimension < 0 || dimension > 3)
        scan_.fail("a name is a dimension, a number and, in quotes, a word");
    }
  }

  void entities() {
    std::array<size_t, 4> number{};
    for (auto& each : number) each = scan_.count(scan_.size(), "entities", 4);
    for (int dimension = 0; dimension < 4; ++dimension)
      for (size_t k = 0; k < number[static_cast<size_t>(dimension)]; ++k) {
        entities_.insert({dimension, scan_.integer()});
        for (int d = 0; d < (dimension == 0 ? 3 : 6); ++d) scan_.real();
        tags();
        if (dimension > 0) tags();
      }
  }
  void tags() {
    for (size_t left = scan_.count(scan_.size(), "tags", 1); left > 0; --left) scan_.integer();
  }
  void entity(int dimension, long long tag) const {
    if (!entities_.contains({dimension, tag}))
      scan_.fail(fmt::format("there is no entity {} of dimension {}", tag, dimension));
  }

  void nodes() {
    if (newer_) {
      scan_.end_line();
      const size_t blocks = scan_.count(scan_.size(), "blocks", 4), number = scan_.count(scan_.size(), "nodes", 6);
      scan_.size(), scan_.size();
      for (size_t b = 0; b < blocks; ++b) {
        const auto dimension = static_cast<int>(scan_.integer());
        entity(dimension, scan_.integer());
        if (scan_.integer() != 0) scan_.fail("parametric nodes are not read");
        const size_t here = scan_.count(scan_.size(), "nodes", 6);
        for (size_t k = 0; k < here; ++k) tags_.push_back(scan_.size());
        for (size_t k = 0; k < 3 * here; ++k) scan_.real();
      }
      if (tags_.size() != number) scan_.fail(fmt::format("{} nodes, {} were said to follow", tags_.size(), number));
    } else {
      const size_t number = scan_.count(scan_.written(), "nodes", 8);
      scan_.end_line();
      for (size_t k = 0; k < number; ++k) {
        tags_.push_back(scan_.integer());
        for (int d = 0; d < 3; ++d) scan_.real();
      }
    }
    std::sort(tags_.begin(), tags_.end());
    if (tags_.empty()) scan_.fail("there are no nodes");
    if (std::adjacent_find(tags_.begin(), tags_.end()) != tags_.end()) scan_.fail("two nodes have the same number");
    // Readers make a table up to the highest number.
    if (tags_.front() < 1 || tags_.back() > 1000000 + 100 * static_cast<long long>(tags_.size()))
      scan_.fail(fmt::format("numbers of nodes from {} to {} for {} nodes", tags_.front(), tags_.back(), tags_.size()));
  }

  int nodes_of(long long type) const {
    switch (type) {
      case 15:
        return 1;
      case 1:
        return 2;
      case 2:
        return 3;
      case 3:
      case 4:
        return 4;
      case 5:
        return 8;
      case 6:
        return 6;  // prisms and pyramids are refused by name later
      case 7:
        return 5;
      default:
        scan_.fail(fmt::format("elements of type {}; only linear ones are read", type));
    }
  }
  void corners(int number) {
    for (int k = 0; k < number; ++k)
      if (const long long tag = newer_ ? scan_.size() : scan_.integer();
          !std::binary_search(tags_.begin(), tags_.end(), tag))
        scan_.fail(fmt::format("an element has the node {}, which is not there", tag));
  }
  int tags_of(long long number) const {
    if (number < 0 || number > 100) scan_.fail(fmt::format("{} tags of an element", number));
    return static_cast<int>(number);
  }

  void elements() {
    if (newer_) {
      scan_.end_line();
      const size_t blocks = scan_.count(scan_.size(), "blocks", 4), number = scan_.count(scan_.size(), "elements", 3);
      scan_.size(), scan_.size();
      size_t found = 0;
      for (size_t b = 0; b < blocks; ++b) {
        const auto dimension = static_cast<int>(scan_.integer());
        entity(dimension, scan_.integer());
        const int each = nodes_of(scan_.integer());
        const size_t here = scan_.count(scan_.size(), "elements", 3);
        for (size_t k = 0; k < here; ++k) scan_.size(), corners(each);
        found += here;
      }
      if (found != number) scan_.fail(fmt::format("{} elements, {} were said to follow", found, number));
      return;
    }
    const size_t number = scan_.count(scan_.written(), "elements", 3);
    scan_.end_line();
    for (size_t found = 0; found < number;) {
      if (scan_.binary) {
        const int each = nodes_of(scan_.integer());
        const size_t here = scan_.count(scan_.integer(), "elements", 4);
        const int labels = tags_of(scan_.integer());
        if (here == 0 || here > number - found) scan_.fail("more elements than were said to follow");
        for (size_t k = 0; k < here; ++k) {
          for (int l = 0; l <= labels; ++l) scan_.integer();
          corners(each);
        }
        found += here;
      } else {
        scan_.integer();
        const int each = nodes_of(scan_.integer());
        for (int left = tags_of(scan_.integer()); left > 0; --left) scan_.integer();
        corners(each);
        ++found;
      }
    }
  }

  /// Nodes that repeat others. Format 2.2 writes this section as text also in binary files.
  void periodic() {
    const bool binary = scan_.binary;
    scan_.end_line();
    if (!newer_) scan_.binary = false;
    std::map<long long, long long> repeats;
    for (size_t links = scan_.count(scan_.size(), "periodic links", 8); links > 0; --links) {
      for (int k = 0; k < 3; ++k) scan_.integer();
      if (newer_) {
        for (size_t left = scan_.count(scan_.size(), "numbers of a transformation", 2); left > 0; --left) scan_.real();
      } else {
        scan_.line();
        if (scan_.next_is("Affine")) scan_.line();
      }
      for (size_t left = scan_.count(scan_.size(), "periodic nodes", 4); left > 0; --left) {
        const long long node = scan_.size(), other = scan_.size();
        for (const long long tag : {node, other})
          if (!std::binary_search(tags_.begin(), tags_.end(), tag))
            scan_.fail(fmt::format("a periodic node {}, which is not there", tag));
        if (node != other) repeats[node] = other;
      }
    }
    for (const auto& [node, other] : repeats) {
      int steps = 0;  // an edge repeats others along three axes at most
      for (auto at = repeats.find(other); at != repeats.end(); at = repeats.find(at->second))
        if (++steps > 3) scan_.fail(fmt::format("the node {} repeats itself over others", node));
    }
    scan_.binary = binary;
  }

  Scanner scan_;
  bool newer_ = false;  ///< format 4.1
  std::vector<long long> tags_;
  std::set<std::pair<int, long long>> entities_;
};

}  // namespace

std::string fault_of_gmsh_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) return "it cannot be read";
  try {
    Check(std::move(text)).all();
  } catch (const Fault& fault) {
    return fault.what();
  }
  return {};
}

}  // namespace silt

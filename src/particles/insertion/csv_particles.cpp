#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>

#include "base/error.hpp"
#include "base/options.hpp"
#include "base/text.hpp"
#include "particles/insertion/particle_file.hpp"

namespace silt {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields(1);
  for (char c : line) {
    if (c == ',')
      fields.emplace_back();
    else
      fields.back() += c;
  }
  for (auto& field : fields) {
    const auto first = field.find_first_not_of(" \t\r\""), last = field.find_last_not_of(" \t\r\"");
    field = first == std::string::npos ? "" : field.substr(first, last - first + 1);
  }
  return fields;
}

const std::vector<std::string> known_columns = {"x",  "y",  "z",  "vx",       "vy",     "vz",      "wx",
                                                "wy", "wz", "id", "diameter", "radius", "material"};

/// Where every column stands in a line.
std::map<std::string, size_t> read_header(const std::string& place, const std::vector<std::string>& names) {
  std::map<std::string, size_t> columns;
  for (size_t k = 0; k < names.size(); ++k) {
    if (std::find(known_columns.begin(), known_columns.end(), names[k]) == known_columns.end())
      throw UserError(
          fmt::format("{}: unknown column '{}'; known are {}", place, names[k], fmt::join(known_columns, ", ")));
    if (!columns.emplace(names[k], k).second)
      throw UserError(fmt::format("{}: column '{}' occurs twice", place, names[k]));
  }
  for (const char* name : {"x", "y", "z"})
    if (!columns.count(name)) throw UserError(fmt::format("{}: column '{}' is missing", place, name));
  if (columns.count("diameter") == columns.count("radius"))
    throw UserError(fmt::format("{}: one of the columns 'diameter' and 'radius' is needed", place));
  for (const char* group : {"v", "w"}) {
    const std::string g = group;
    const auto given = columns.count(g + "x") + columns.count(g + "y") + columns.count(g + "z");
    if (given != 0 && given != 3)
      throw UserError(fmt::format("{0}: of the columns {1}x, {1}y, {1}z all or none are needed", place, g));
  }
  return columns;
}

}  // namespace

std::vector<FileParticle> read_csv_particles(const std::string& file, const std::vector<std::string>& materials) {
  std::ifstream in(file);
  if (!in) throw UserError(fmt::format("particle file '{}' cannot be read", file));
  std::map<std::string, size_t> columns;
  std::vector<FileParticle> particles;
  std::string text;
  for (int line = 1; std::getline(in, text); ++line) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string::npos || text[first] == '#') continue;
    const auto fields = split(text);
    const std::string place = fmt::format("{}:{}", file, line);
    if (columns.empty()) {
      columns = read_header(place, fields);
      continue;
    }
    if (fields.size() != columns.size())
      throw UserError(
          fmt::format("{}: {} values where the header names {} columns", place, fields.size(), columns.size()));
    const auto number = [&](const std::string& column) {
      const std::string& field = fields[columns.at(column)];
      double value = 0;
      const char* begin = field.data() + (field.size() > 1 && field[0] == '+');
      const auto [end, error] = std::from_chars(begin, field.data() + field.size(), value);
      if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value))
        throw UserError(fmt::format("{}: column '{}': '{}' is not a number", place, column, field));
      return value;
    };
    FileParticle particle;
    particle.line = line;
    particle.position = Vec3(number("x"), number("y"), number("z"));
    const bool diameter = columns.count("diameter");
    particle.radius = diameter ? 0.5 * number("diameter") : number("radius");
    if (!(particle.radius > 0))
      throw UserError(fmt::format("{}: column '{}' must be above 0", place, diameter ? "diameter" : "radius"));
    if (columns.count("vx")) particle.velocity = Vec3(number("vx"), number("vy"), number("vz"));
    if (columns.count("wx")) particle.spin = Vec3(number("wx"), number("wy"), number("wz"));
    if (columns.count("material")) {
      const std::string& name = fields[columns["material"]];
      const auto found = std::find(materials.begin(), materials.end(), lower_case(name));
      if (found == materials.end())
        throw UserError(fmt::format("{}: column 'material': '{}' is not a material; there are {}", place, name,
                                    fmt::join(materials, ", ")));
      particle.material = static_cast<int>(found - materials.begin());
    }
    particles.push_back(particle);
  }
  if (columns.empty()) throw UserError(fmt::format("particle file '{}' has no header line", file));
  return particles;
}

}  // namespace silt

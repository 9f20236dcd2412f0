#include "particles/walls/rigid_wall.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "particles/walls/facet_shapes.hpp"

namespace silt {
namespace {

WallSideChoice side_of(const RigidWallOptions& options) {
  return options.side == "inside"    ? WallSideChoice::inside
         : options.side == "outside" ? WallSideChoice::outside
                                     : WallSideChoice::both;
}

/// Which of the options that give a shape this type needs and knows; throws UserError for others and for missing ones.
void check_given(const RigidWallOptions& options, const std::string& prefix) {
  struct Rule {
    const char* option;
    bool given;
    const char *needed, *known;  // types, between blanks
  };
  const Rule rules[] = {
      {"point", options.point.has_value(), " plane sphere cylinder cone revolution ", ""},
      {"normal", options.normal.has_value(), " plane ", ""},
      {"axis", options.axis.has_value(), " cylinder cone revolution ", ""},
      {"radius", options.radius.has_value(), " sphere cylinder cone ", ""},
      {"end_radius", options.end_radius.has_value(), " cone ", ""},
      {"length", options.length.has_value(), " cone ", " cylinder "},
      {"profile", !options.profile.empty(), " revolution ", ""},
      {"lower", options.lower.has_value(), " box ", ""},
      {"upper", options.upper.has_value(), " box ", ""},
      {"file", !options.file.empty(), " stl ", ""},
      {"ends", options.ends != "open", "", " cylinder cone "},
      {"scale", options.scale != 1, "", " stl "},
      {"offset", options.offset.norm() > 0, "", " stl "},
  };
  const std::string type = " " + options.type + " ";
  for (const Rule& rule : rules) {
    const bool needed = std::string(rule.needed).find(type) != std::string::npos;
    const bool known = needed || std::string(rule.known).find(type) != std::string::npos;
    if (rule.given && !known)
      throw UserError(
          fmt::format("option -{}_{}: a wall of type {} has no {}", prefix, rule.option, options.type, rule.option));
    if (needed && !rule.given)
      throw UserError(
          fmt::format("option -{}_{} is missing: a wall of type {} needs it", prefix, rule.option, options.type));
  }
  if (options.axis && options.axis->norm() == 0)
    throw UserError(fmt::format("option -{}_axis: it has no direction", prefix));
  if (options.normal && options.normal->norm() == 0)
    throw UserError(fmt::format("option -{}_normal: it has no direction", prefix));
}

/// The profile of a cylinder, a cone or a given line.
std::vector<RevolutionShape::Corner> profile_of(const RigidWallOptions& options, const std::string& prefix,
                                                double far) {
  std::vector<RevolutionShape::Corner> corners;
  if (options.type == "revolution") {
    if (options.profile.size() < 4 || options.profile.size() % 2)
      throw UserError(
          fmt::format("option -{}_profile: {} numbers; wanted are pairs, distance along the axis and from it, of two "
                      "points or more",
                      prefix, options.profile.size()));
    for (std::size_t k = 0; k < options.profile.size(); k += 2)
      corners.push_back({options.profile[k], options.profile[k + 1]});
  } else {
    const double end = options.end_radius.value_or(*options.radius);
    const double length = options.length.value_or(far);
    if (options.ends == "closed") {
      if (!options.length) throw UserError(fmt::format("option -{}_ends: closed ends need -{}_length", prefix, prefix));
      corners = {{0, 0}, {0, *options.radius}, {length, end}, {length, 0}};
    } else {
      corners = {{options.length ? 0 : -far, *options.radius}, {length, end}};
    }
    if (options.ends == "closed" && end == 0) corners.pop_back();
  }
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (corners[k].out < 0)
      throw UserError(
          fmt::format("option -{}_profile: {:g} m from the axis; allowed: at least 0", prefix, corners[k].out));
    if (k > 0 && std::hypot(corners[k].along - corners[k - 1].along, corners[k].out - corners[k - 1].out) == 0)
      throw UserError(fmt::format("-{}: the profile has the same point twice", prefix));
  }
  return corners;
}

}  // namespace

void RigidWallOptions::options(OptionGroup& option) {
  option("type", type, {"plane", "box", "cylinder", "cone", "sphere", "revolution", "stl"},
         "shape of a wall that is no boundary of the mesh");
  option("material", material, "material of the wall; default: the first material in alphabetical order");
  option("temperature", temperature,
         "K, formula in x, y, z, t: temperature of the wall, which particles that touch it are warmed by "
         "(-heat_conduction); default: it conducts no heat");
  option("side", side, {"inside", "outside", "both"},
         "where the particles are that feel the wall (plane: inside is where its normal points)");
  option("point", point, "m", "a point of the plane, the start of the axis, the centre of the sphere");
  option("normal", normal, "-", "normal of the plane, towards the particles");
  option("axis", axis, "-", "direction of the axis of a cylinder, cone or surface of revolution");
  option("radius", radius, "m", "radius of the sphere, of the cylinder, of the cone at its start", positive);
  option("end_radius", end_radius, "m", "radius of the cone at its end; 0: it ends in a tip", non_negative);
  option("length", length, "m", "length along the axis; a cylinder without it has no ends", positive);
  option("ends", ends, {"open", "closed"}, "whether discs close the ends of a cylinder or cone");
  option("profile", profile, "m",
         "line that turns about the axis: distance along the axis and from it, of each of its corners; for the side "
         "inside the particles are on its right (towards the axis where it runs along it)");
  option("lower", lower, "m", "lowest corner of the box");
  option("upper", upper, "m", "highest corner of the box");
  option("file", file, "STL file, ASCII or binary");
  option("scale", scale, "-", "factor on the coordinates of the STL file (0.001: written in mm)", positive);
  option("offset", offset, "m", "by which the scaled coordinates of the STL file are moved");
  motion.options(option);
}

double FacetShape::clearance(const Vec3& x) const { return both ? room->wall_distance(x, 1e150) : room->depth(x); }

RigidWall::RigidWall(const std::string& name, const RigidWallOptions& options, const Surface& domain, int material,
                     double smooth_angle)
    : name_(name), material_(material), lower_(domain.lower), upper_(domain.upper) {
  const std::string prefix = "wall_" + name;
  check_given(options, prefix);
  if (!options.temperature.empty()) temperature_.emplace(prefix + "_temperature", options.temperature);
  for (const auto& [property, direction] : {std::pair{"normal", options.normal}, std::pair{"axis", options.axis}})
    if (direction && direction->norm() == 0)
      throw UserError(fmt::format("option -{}_{}: it has no direction", prefix, property));
  WallMotionOptions motion = options.motion;
  const WallSideChoice side = side_of(options);
  if (options.type == "plane") {
    if (options.side == "outside")
      throw UserError(fmt::format("option -{}_side: turn the normal of a plane round instead", prefix));
    shape_ = PlaneShape{*options.point, options.normal->normalized(), side == WallSideChoice::both};
    endless_ = true;
  } else if (options.type == "sphere") {
    shape_ = SphereShape{*options.point, *options.radius, side};
  } else if (options.type == "box" || options.type == "stl") {
    FacetShape shape = options.type == "box"
                           ? box_shape(*options.lower, *options.upper, side, domain, prefix, smooth_angle)
                           : stl_shape(options.file, options.scale, options.offset, side, domain, prefix, smooth_angle);
    if (!motion.rotation_centre) motion.rotation_centre = 0.5 * (shape.box.lower + shape.box.upper);
    shape_ = std::move(shape);
  } else {
    const double far = 4 * (upper_ - lower_).norm();
    endless_ = options.type == "cylinder" && !options.length;
    shape_ = RevolutionShape{*options.point, options.axis->normalized(), profile_of(options, prefix, far), side};
  }
  if (options.point && !motion.rotation_centre) motion.rotation_centre = options.point;
  motion_ = WallMotion(motion, prefix);
  if (const auto* revolution = std::get_if<RevolutionShape>(&shape_))
    still_shape_ = motion_.about(revolution->start, revolution->axis);
  if (const auto* plane = std::get_if<PlaneShape>(&shape_)) still_shape_ = motion_.parallel(plane->normal);
  if (const auto* sphere = std::get_if<SphereShape>(&shape_)) still_shape_ = motion_.centre() == sphere->centre;
  motion_.pose(0);
  mark();
}

double RigidWall::moved() const {
  if (!motion_.moves()) return 0;
  if (const auto* plane = std::get_if<PlaneShape>(&shape_); plane && (still_shape_ || !motion_.rotates()))
    return std::abs(plane->normal.dot(motion_.shift() - marked_.shift));
  if (still_shape_ || !motion_.rotates()) return (motion_.shift() - marked_.shift).norm();
  // The displacement is linear in the point, hence largest in a corner of the domain.
  double most = 0;
  for (int c = 0; c < 8; ++c) {
    Vec3 x;
    for (int d = 0; d < 3; ++d) x[d] = c >> d & 1 ? upper_[d] : lower_[d];
    most = std::max(most, (motion_.carried(x, marked_) - x).norm());
  }
  return most;
}

bool RigidWall::repeats(const Vec3& shift) const {
  if (shift.norm() == 0) return true;
  if (!endless_) return true;
  const auto* cylinder = std::get_if<RevolutionShape>(&shape_);
  return cylinder && std::abs(cylinder->axis.dot(shift)) <= 1e-12 * shift.norm();
}

bool RigidWall::near(const Vec3& centre, const Vec3& shift, double reach, std::vector<int>& items) const {
  const Vec3 x = to_shape(centre - shift);
  if (const auto* facets = std::get_if<FacetShape>(&shape_)) {
    const std::size_t before = items.size();
    facets->wall.near(x, reach, items);
    return items.size() > before;
  }
  return std::visit([&](const auto& shape) { return std::abs(shape.clearance(x)) <= reach; }, shape_);
}

void RigidWall::touch(const Vec3& centre, const Vec3& shift, double radius, const int* first, const int* last,
                      std::vector<WallPoint>& points) const {
  const std::size_t before = points.size();
  const Vec3 x = to_shape(centre - shift);
  if (const auto* facets = std::get_if<FacetShape>(&shape_))
    facets->wall.touch(x, radius, first, last, points);
  else if (const auto* plane = std::get_if<PlaneShape>(&shape_))
    plane->touch(x, radius, points);
  else if (const auto* sphere = std::get_if<SphereShape>(&shape_))
    sphere->touch(x, radius, points);
  else
    std::get<RevolutionShape>(shape_).touch(x, radius, points);
  if (!motion_.rotates() || still_shape_) return;
  for (std::size_t k = before; k < points.size(); ++k) {
    auto normal = vec3(points[k].normal);
    normal = motion_.direction_to_present(normal);
  }
}

double RigidWall::clearance(const Vec3& x, const Vec3& shift) const {
  const Vec3 at = to_shape(x - shift);
  return std::visit([&](const auto& shape) { return shape.clearance(at); }, shape_);
}

}  // namespace silt

#include "base/surface_motion.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/expression.hpp"

namespace silt {

std::string SurfaceMotion::formula(const std::string& prefix, const std::string& velocity) const {
  const Expression rate(prefix + "_rotation_rate", rotation_rate);
  if (!rate.uniform())
    throw UserError(
        fmt::format("-{}_rotation_rate: '{}' depends on the place; a wall turns as a whole", prefix, rotation_rate));
  if (rate.constant() && rate(Vec3::Zero(), 0) == 0) return velocity;
  if (rotation_axis.norm() == 0) throw UserError(fmt::format("-{}_rotation_axis: it has no direction", prefix));
  const auto parts = split_formulas(prefix + "_velocity", velocity);
  const Vec3 n = rotation_axis.normalized(), c = rotation_centre;
  const char* x[3] = {"x", "y", "z"};
  std::string text;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    text += fmt::format("{}({}) + ({})*(({:.17g})*({} - ({:.17g})) - ({:.17g})*({} - ({:.17g})))", i ? ", " : "",
                        parts[i], rotation_rate, n[j], x[k], c[k], n[k], x[j], c[j]);
  }
  return text;
}

}  // namespace silt

#include "particles/law_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "particles/contact_laws.hpp"
#include "particles/contact_lists.hpp"
#include "particles/field_table.hpp"
#include "particles/store.hpp"

namespace silt {
namespace {

/// Two equal particles and their contact, through the loops of the solver.
class LedPair {
 public:
  LedPair(const ContactLaws& laws, double radius, double mass)
      : laws_(laws), radius_(radius), lists_(laws.history_components()), kernels_(choose_kernels("plain")) {
    store_.owned = 2;
    store_.reserve(2);
    store_.id = {0, 1};
    for (int p = 0; p < 2; ++p) {
      store_.motion[p] = Motion{};
      store_.rotation[p] = Rotation{};
      store_.motion[p].radius = radius;
      store_.motion[p].inverse_mass = 1 / mass;
    }
    store_.place_padding();
    const std::vector<double> history(laws.history_components() + 1, 0.0);
    lists_.add_contact(0, 1, history.data(), 1);
    lists_.pad(store_.padding(), store_.owned);
  }

  /// Load on the one particle after a step: it is above the other by the gap, nears it with the speed `approach`, slips
  /// along x and turns with half the relative spin.
  const Load& at(double gap, double approach, double slip, const Vec3& spin, double dt) {
    Motion& a = store_.motion[0];
    vec3(a.position) = Vec3(0, 0, 2 * radius_ + gap);
    vec3(a.velocity) = Vec3(slip, 0, -approach);
    vec3(store_.rotation[0].spin) = 0.5 * spin, vec3(store_.rotation[1].spin) = -0.5 * spin;
    store_.present[0] = store_.present[1] = Load{};
    PairSweep sweep;
    sweep.motion = store_.motion.data();
    sweep.rotation = store_.rotation.data();
    sweep.load = store_.present.data();
    sweep.pairs = lists_.pairs();
    sweep.laws = laws_.setup();
    sweep.dt = dt;
    sweep.leaving = lists_.leaving();
    if (gap <= laws_.setup().leave_gap) kernels_.pairs(sweep);
    wet(gap, approach);
    return store_.present[0];
  }

 private:
  /// Bridges form and break as between two particles with full films (liquid_exchange.hpp).
  void wet(double gap, double speed) {
    const auto* law = std::get_if<CapillaryBridge>(&laws_.bridge());
    if (!law) return;
    const int first = laws_.setup().bridge.first_history;
    double &mine = lists_.history(first, 0), &other = lists_.history(first + 1, 0);
    const double volume = mine + other;
    if (volume == 0 && gap < 0) mine = other = CapillaryBridge::film_share(1, 1) * law->full_film(radius_);
    if (gap > law->rupture_distance(volume, radius_ / 2, law->capillary_number(speed))) mine = other = 0;
  }

  const ContactLaws& laws_;
  double radius_;
  Store store_;
  ContactLists lists_;
  const Kernels& kernels_;
};

}  // namespace

std::string law_table(Options& options) {
  LawTableOptions chosen;
  options.read("law_table", chosen);
  if (chosen.motion == "field") return field_table(options, chosen);
  const Materials materials(options);
  if (materials.count() == 0) throw UserError("-law_table_motion needs a material: give -material_<name>_density");
  ContactLaws laws(options, materials);
  ParticleSizes sizes(materials.count());
  for (int m = 0; m < materials.count(); ++m) sizes.smallest[m] = sizes.largest[m] = chosen.radius;
  laws.set_sizes(sizes);
  const double radius = chosen.radius,
               mass = *materials[0].density * 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3);
  LedPair pair(laws, radius, mass);
  const double far = chosen.gap.value_or(1.05 * laws.setup().leave_gap + 0.1 * chosen.depth);
  const int rows = chosen.rows;
  std::string text;
  if (chosen.motion == "normal") {
    text = "gap,force\n";
    // Steps that grow with the distance from the smallest gap of interest, so that both ends are resolved.
    const double least = std::min(chosen.depth, far) * 1e-3;
    const auto place = [&](int k) {
      const double bend = std::asinh(far / least) + std::asinh(chosen.depth / least);
      return least * std::sinh(std::asinh(far / least) - bend * k / (rows - 1));
    };
    for (int leg = 0; leg < 2; ++leg)
      for (int k = 0; k < rows; ++k) {
        const double gap = place(leg == 0 ? k : rows - 1 - k);
        const Load& load = pair.at(gap, leg == 0 ? chosen.speed : -chosen.speed, 0, Vec3::Zero(), 0);
        text += fmt::format("{:.9g},{:.9g}\n", gap, load.force[2]);
      }
    return text;
  }
  if (!(chosen.amplitude > 0)) throw UserError("-law_table_motion to and fro needs -law_table_amplitude (m, positive)");
  const bool slides = chosen.motion == "tangential", twists = chosen.motion == "twisting";
  text = slides ? "slip,force\n" : "angle,torque\n";
  // Pressed together slowly first, so that the laws know the contact.
  for (int k = 1; k <= rows; ++k) pair.at(-chosen.depth * k / rows, 0, 0, Vec3::Zero(), 0);
  const Vec3 axis = twists ? Vec3::UnitZ() : Vec3::UnitY();
  const double dt = chosen.amplitude / chosen.speed / rows;
  double place = 0;
  for (const int way : {1, -1, -1, 1, 1})
    for (int k = 0; k < rows; ++k) {
      const double speed = way * chosen.speed;
      place += speed * dt;
      const Load& load =
          pair.at(-chosen.depth, 0, slides ? speed : 0, slides ? Vec3(Vec3::Zero()) : speed / radius * axis, dt);
      text += fmt::format("{:.9g},{:.9g}\n", slides ? place : place / radius,
                          slides ? load.force[0] : vec3(load.torque).dot(axis));
    }
  return text;
}

}  // namespace silt

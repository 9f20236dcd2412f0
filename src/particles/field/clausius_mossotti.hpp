#pragma once
#include <complex>
#include <numbers>

namespace silt {

/// A sphere in a fluid: permittivities (F/m) and conductivities (S/m).
struct Dielectric {
  double particle_permittivity, fluid_permittivity;
  double particle_conductivity = 0, fluid_conductivity = 0;

  /// K in a constant field without conduction (7.68): between -1/2 and 1.
  double insulating() const {
    return (particle_permittivity - fluid_permittivity) / (particle_permittivity + 2 * fluid_permittivity);
  }
  /// The same by conductivities: what a constant field comes to after many relaxation times.
  double conducting() const {
    return (particle_conductivity - fluid_conductivity) / (particle_conductivity + 2 * fluid_conductivity);
  }
  /// K of an alternating field (7.73), w in rad/s.
  std::complex<double> at(double frequency) const {
    using Complex = std::complex<double>;
    return Complex(particle_permittivity - fluid_permittivity,
                   -(particle_conductivity - fluid_conductivity) / frequency) /
           Complex(particle_permittivity + 2 * fluid_permittivity,
                   -(particle_conductivity + 2 * fluid_conductivity) / frequency);
  }
  /// s, Maxwell & Wagner's relaxation time (e_p + 2 e_f)/(l_p + 2 l_f) (7.74).
  double relaxation() const {
    return (particle_permittivity + 2 * fluid_permittivity) / (particle_conductivity + 2 * fluid_conductivity);
  }
};

}  // namespace silt

#pragma once
#include <numbers>

namespace silt {

// Exact values of the SI (2019); the electric and magnetic constants by CODATA 2018.
inline constexpr double boltzmann_constant = 1.380649e-23;              ///< J/K
inline constexpr double avogadro_constant = 6.02214076e23;              ///< 1/mol
inline constexpr double elementary_charge = 1.602176634e-19;            ///< C
inline constexpr double stefan_boltzmann_constant = 5.670374419e-8;     ///< W/(m2 K4)
inline constexpr double vacuum_permittivity = 8.8541878128e-12;         ///< F/m
inline constexpr double vacuum_permeability = 4e-7 * std::numbers::pi;  ///< H/m, to 6e-10

}  // namespace silt

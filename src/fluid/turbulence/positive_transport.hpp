#pragma once
#include <array>

#include "fluid/transport/scalar_system.hpp"
#include "fluid/turbulence/vertex_rule.hpp"

namespace silt {

/// One implicit step of a quantity that must not become negative (docs/theory/turbulence.md, T20 and T21): the matrix
/// is an M-matrix by artificial diffusion along the edges of a cell where it is needed, the right side is not negative,
/// so neither is the solution, whatever the step. What the artificial diffusion took away is given back, limited to
/// where the solution is smooth (algebraic flux correction: Kuzmin, J. Comput. Phys. 228 (2009) 2517), with the last
/// iterate; a negative rest of it enters as a coefficient (Patankar 1980), which is zero or positive.
class PositiveTransport {
 public:
  PositiveTransport(const VertexRule& rule, const NodalGraph& graph, const std::string& prefix);

  /// All [nodes], consistent on shared nodes.
  struct Terms {
    const std::vector<double>* flux = nullptr;  ///< [nodes][3] kg/(m2 s), alpha rho u
    std::vector<double> storage;                ///< kg/m3, alpha rho
    std::vector<double> history;                ///< 1/s times phi, c1 phi^n - c2 phi^{n-1}
    std::vector<double> diffusivity;            ///< kg/(m s)
    std::vector<double> production;             ///< density of what is produced, not negative
    std::vector<double> destruction;            ///< density of the coefficient of phi, not negative
    double rate = 0;                            ///< 1/s, c0
    std::vector<double> entering;               ///< kg/s coefficient at nodes of open boundaries; empty: none
    std::vector<double> entering_value;         ///< phi of what enters there
    explicit Terms(int nodes)
        : storage(nodes), history(nodes), diffusivity(nodes), production(nodes), destruction(nodes) {}
  };
  /// phi: the last iterate (not negative), `fixed` nodes hold their values; the solution afterwards. Returns the linear
  /// iterations; throws SolveFailure. Collective.
  int solve(const Terms& terms, const std::vector<char>& fixed, std::vector<double>& phi);

 private:
  const VertexRule& rule_;
  const NodalGraph& graph_;
  ScalarSystem system_;
};

}  // namespace silt

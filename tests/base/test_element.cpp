#include <catch2/catch.hpp>
#include <cmath>

#include "base/element.hpp"

using namespace silt;

TEST_CASE("Shape functions sum to one and their gradients to zero") {
  for (Cell cell : {Cell::triangle, Cell::quadrilateral, Cell::tetrahedron, Cell::hexahedron}) {
    const double xi[3] = {0.2, 0.3, cell_dimension(cell) == 3 ? 0.1 : 0};
    double N[8], dN[8][3], sum = 0, gradient[3] = {};
    shape(cell, xi, N, dN);
    for (int a = 0; a < cell_nodes(cell); ++a) {
      sum += N[a];
      for (int d = 0; d < 3; ++d) gradient[d] += dN[a][d];
    }
    CHECK(sum == Approx(1).epsilon(1e-15));
    for (double g : gradient) CHECK(std::abs(g) < 1e-15);
  }
}

TEST_CASE("Quadrature integrates the monomials of its degree exactly") {
  const auto factorial = [](int n) { return std::tgamma(n + 1); };
  for (Cell cell : {Cell::triangle, Cell::quadrilateral, Cell::tetrahedron, Cell::hexahedron})
    for (int degree = 1; degree <= 5; ++degree) {
      const Quadrature rule = quadrature(cell, degree);
      const bool simplex = cell == Cell::triangle || cell == Cell::tetrahedron;
      const int dimension = cell_dimension(cell);
      for (int i = 0; i <= degree; ++i)
        for (int j = 0; j + i <= degree; ++j)
          for (int k = 0; k + j + i <= (dimension == 3 ? degree : i + j); ++k) {
            double sum = 0;
            for (int q = 0; q < rule.points; ++q)
              sum += rule.weight[q] * std::pow(rule.point[q][0], i) * std::pow(rule.point[q][1], j) *
                     std::pow(rule.point[q][2], k);
            const double exact = simplex ? factorial(i) * factorial(j) * factorial(k) / factorial(i + j + k + dimension)
                                         : 1.0 / ((i + 1) * (j + 1) * (dimension == 3 ? k + 1 : 1));
            INFO(name(cell) << " degree " << degree << " x^" << i << " y^" << j << " z^" << k);
            CHECK(sum == Approx(exact).epsilon(1e-12));
          }
    }
}

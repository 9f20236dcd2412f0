#pragma once

namespace silt {

/// The inverse of a cell's map J[i][d] = d x_i / d xi_d, for one number or a pack of lanes; returns the determinant.
template <int dim, class V>
V invert(const V (&J)[dim][dim], V (&inverse)[dim][dim]) {
  V determinant;
  if constexpr (dim == 2) {
    determinant = J[0][0] * J[1][1] - J[0][1] * J[1][0];
    const V r = 1.0 / determinant;
    inverse[0][0] = J[1][1] * r;
    inverse[0][1] = -J[0][1] * r;
    inverse[1][0] = -J[1][0] * r;
    inverse[1][1] = J[0][0] * r;
  } else {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        inverse[j][i] = J[i1][j1] * J[i2][j2] - J[i1][j2] * J[i2][j1];
      }
    determinant = J[0][0] * inverse[0][0] + J[0][1] * inverse[1][0] + J[0][2] * inverse[2][0];
    const V r = 1.0 / determinant;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) inverse[i][j] *= r;
  }
  return determinant;
}

}  // namespace silt

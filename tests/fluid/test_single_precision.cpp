#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "flow_case.hpp"
#include "fluid/single_precision_blocks.hpp"

using namespace silt;
using namespace silt::test;

namespace {

constexpr int side = 5, rows = side * side * side;

/// Blocks of 4 x 4 between the neighbours of a cube of nodes, the diagonal ones heavier than all others together.
MatHandle random_blocks(double size) {
  MatHandle matrix;
  SILT_PETSC(MatCreateSeqBAIJ(PETSC_COMM_SELF, 4, 4 * rows, 4 * rows, 27, nullptr, matrix.out()));
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < rows; ++j) {
      bool near = true;
      for (int a = i, b = j, d = 0; d < 3; a /= side, b /= side, ++d) near = near && std::abs(a % side - b % side) < 2;
      if (!near) continue;
      double block[16];
      for (double& entry : block) entry = size * number(generator);
      for (int k = 0; i == j && k < 4; ++k) block[5 * k] += 60 * size;
      SILT_PETSC(MatSetValuesBlocked(matrix, 1, &i, 1, &j, block, INSERT_VALUES));
    }
  SILT_PETSC(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  SILT_PETSC(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  return matrix;
}

void set_block(Mat matrix, int row, double value) {
  const std::vector<double> block(16, value);
  SILT_PETSC(MatSetValuesBlocked(matrix, 1, &row, 1, &row, block.data(), INSERT_VALUES));
  SILT_PETSC(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  SILT_PETSC(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
}

std::vector<double> values_of(Vec v) {
  const double* array;
  SILT_PETSC(VecGetArrayRead(v, &array));
  std::vector<double> result(array, array + 4 * rows);
  SILT_PETSC(VecRestoreArrayRead(v, &array));
  return result;
}

}  // namespace

TEST_CASE(
    "Incomplete factors and products in single precision are PETSc's but for rounding, whatever the right side's size",
    "[monolithic]") {
  const int levels = GENERATE(0, 1, 2);
  const MatHandle matrix = random_blocks(3);
  VecHandle r, x, y;
  SILT_PETSC(MatCreateVecs(matrix, r.out(), x.out()));
  SILT_PETSC(VecDuplicate(r, y.out()));
  for (int i = 0; i < 4 * rows; ++i) SILT_PETSC(VecSetValue(r, i, std::sin(i * i), INSERT_VALUES));
  Handle<PC, PCDestroy> pc;
  SILT_PETSC(PCCreate(PETSC_COMM_SELF, pc.out()));
  SILT_PETSC(PCSetType(pc, PCILU));
  SILT_PETSC(PCFactorSetLevels(pc, levels));
  SILT_PETSC(PCFactorSetMatOrderingType(pc, MATORDERINGRCM));
  SILT_PETSC(PCSetOperators(pc, matrix, matrix));
  SILT_PETSC(PCSetUp(pc));
  SILT_PETSC(PCApply(pc, r, x));
  SILT_PETSC(MatMult(matrix, r, y));
  Mat factors;
  MatInfo info;
  SILT_PETSC(PCFactorGetMatrix(pc, &factors));
  SILT_PETSC(MatGetInfo(factors, MAT_LOCAL, &info));
  const auto right = values_of(r), solved = values_of(x), image = values_of(y);
  double largest = 0, largest_image = 0;
  for (int i = 0; i < 4 * rows; ++i) {
    largest = std::max(largest, std::abs(solved[i]));
    largest_image = std::max(largest_image, std::abs(image[i]));
  }
  BlockIlu ilu(levels);
  BlockProduct product;
  REQUIRE(ilu.factor(matrix));
  REQUIRE(product.copy(matrix));
  CHECK(16.0 * static_cast<double>(ilu.blocks()) == info.nz_used);
  for (const double size : {1.0, 1e-60, 1e60}) {
    std::vector<double> scaled = right, answer(4 * rows), multiplied(4 * rows);
    for (double& entry : scaled) entry *= size;
    ilu.solve(scaled.data(), answer.data());
    product.multiply(scaled.data(), multiplied.data());
    double error = 0, difference = 0;
    for (int i = 0; i < 4 * rows; ++i) {
      error = std::max(error, std::abs(answer[i] / size - solved[i]));
      difference = std::max(difference, std::abs(multiplied[i] / size - image[i]));
    }
    CHECK(error < 3e-6 * largest);
    CHECK(difference < 1e-6 * largest_image);
  }
  std::vector<double> nothing(4 * rows, 0.0), answer(4 * rows, 1.0);
  ilu.solve(nothing.data(), answer.data());
  CHECK(answer == nothing);
}

TEST_CASE("Factors with all their fill are those of the matrix itself", "[monolithic]") {
  const MatHandle matrix = random_blocks(3);
  VecHandle x, r;
  SILT_PETSC(MatCreateVecs(matrix, x.out(), r.out()));
  for (int i = 0; i < 4 * rows; ++i) SILT_PETSC(VecSetValue(x, i, std::sin(i * i), INSERT_VALUES));
  SILT_PETSC(MatMult(matrix, x, r));
  const auto exact = values_of(x), right = values_of(r);
  const auto error = [&](int levels) {
    BlockIlu ilu(levels);
    REQUIRE(ilu.factor(matrix));
    std::vector<double> answer(4 * rows);
    ilu.solve(right.data(), answer.data());
    double largest = 0;
    for (int i = 0; i < 4 * rows; ++i) largest = std::max(largest, std::abs(answer[i] - exact[i]));
    return largest;
  };
  CHECK(error(rows) < 1e-6);
  CHECK(error(0) > 1e-4);  // the blocks left out count
}

TEST_CASE("A matrix that single precision cannot hold, or that has a singular pivot, is left to PETSc",
          "[monolithic]") {
  BlockIlu ilu(1);
  BlockProduct product;
  for (const double size : {1e-30, 1e30}) {
    const MatHandle matrix = random_blocks(size);
    CHECK_FALSE(ilu.factor(matrix));
    CHECK_FALSE(product.copy(matrix));
  }
  const MatHandle matrix = random_blocks(1);
  CHECK(ilu.factor(matrix));
  // All entries of a block alike: whichever row is first in the order of the factors has a singular pivot.
  for (int i = 0; i < rows; ++i) set_block(matrix, i, 1);
  CHECK_FALSE(ilu.factor(matrix));
  CHECK(product.copy(matrix));
  set_block(matrix, 7, std::numeric_limits<double>::quiet_NaN());
  CHECK_FALSE(ilu.factor(matrix));
  CHECK_FALSE(product.copy(matrix));
}

TEST_CASE("Single precision in the local stage changes neither the flow nor the iterations", "[monolithic]") {
  const std::string cell = GENERATE("hexahedron", "tetrahedron");
  struct Outcome {
    std::vector<double> velocity;
    int newton = 0, linear = 0;
  };
  const auto run = [&](bool of_petsc) {
    std::vector<std::pair<std::string, std::string>> settings = {{"mesh_type", "box"},
                                                                 {"mesh_cell", cell},
                                                                 {"mesh_cells", "8, 8, 8"},
                                                                 {"fluid_scheme", "monolithic"},
                                                                 {"fluid_density", "1"},
                                                                 {"fluid_viscosity", "0.01"},
                                                                 {"fluid_pressure_stage", "yes"},
                                                                 {"boundary_z_max_velocity", "1, 0, 0"}};
    for (const char* side : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"})
      settings.emplace_back(std::string("boundary_") + side + "_type", "no_slip");
    if (of_petsc) SILT_PETSC(PetscOptionsSetValue(nullptr, "-fluid_sub_pc_factor_mat_ordering_type", "rcm"));
    FlowCase flow(settings);
    Outcome outcome;
    for (int k = 0; k < 6; ++k) {
      const FluidStep step = flow.advance(0.05);
      outcome.newton += step.newton_iterations;
      outcome.linear += step.velocity_iterations;
    }
    if (of_petsc) SILT_PETSC(PetscOptionsClearValue(nullptr, "-fluid_sub_pc_factor_mat_ordering_type"));
    outcome.velocity.assign(flow.fluid->velocity().begin(), flow.fluid->velocity().end());
    return outcome;
  };
  const Outcome single = run(false), of_petsc = run(true);
  CHECK(single.newton == of_petsc.newton);
  CHECK(std::abs(single.linear - of_petsc.linear) <= 2);
  double difference = 0;
  for (size_t i = 0; i < single.velocity.size(); ++i)
    difference = std::max(difference, std::abs(single.velocity[i] - of_petsc.velocity[i]));
  CHECK(difference < 1e-8);
  CHECK(difference > 0);  // both were really used
}

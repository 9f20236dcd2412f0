#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <sstream>

#include "app/expectations.hpp"
#include "app/probes.hpp"
#include "app/profiles.hpp"
#include "base/error.hpp"
#include "support/temporary_directory.hpp"

using namespace silt;

namespace {

ExpectationOptions expected(double value, double tolerance, const std::string& mode = "relative") {
  ExpectationOptions options;
  options.value = value;
  options.tolerance = tolerance;
  options.mode = mode;
  return options;
}

/// A cosine of 5 Hz about 2 with amplitude 0.5 over one second.
void wave(std::vector<double>& times, std::vector<double>& values) {
  for (int k = 0; k <= 1000; ++k) {
    times.push_back(1e-3 * k);
    values.push_back(2 + 0.5 * std::cos(2 * M_PI * 5 * times.back()));
  }
}

std::string refusal(const std::vector<std::pair<std::string, std::string>>& given) {
  Options options;
  for (const auto& [name, value] : given) options.set("expect_a_" + name, value);
  try {
    Expectations(options, {"pressure_drop", "bed_height"}, {"wall.velocity_x"});
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("an expected figure is compared with the last value, at a time, or with a statistic of a window", "[app]") {
  std::vector<double> t, v;
  wave(t, v);
  auto options = expected(2.5, 1e-12);
  CHECK(Expectations::verdict(options, t, v).pass);  // the last value
  options = expected(2, 1e-3);
  options.at = 0.05;  // a quarter of the period: 2
  CHECK(Expectations::verdict(options, t, v).pass);
  options.at = 0.0505;  // between two steps
  CHECK(Expectations::verdict(options, t, v).computed ==
        Approx(2 + 0.5 * std::cos(2 * M_PI * 5 * 0.0505)).epsilon(1e-4));
  options.at = 2.0;  // never reached: no figure is no pass
  CHECK_FALSE(Expectations::verdict(options, t, v).pass);
  options = expected(2, 1e-6);
  options.window = {0.2, 0.8};
  CHECK(Expectations::verdict(options, t, v).pass);
  options.window = {0.2, 1.8};
  CHECK_FALSE(Expectations::verdict(options, t, v).pass);
  options.window.clear();
  for (const auto& [statistic, value] : std::vector<std::pair<std::string, double>>{
           {"minimum", 1.5}, {"maximum", 2.5}, {"amplitude", 0.5}, {"frequency", 5}, {"mean", 2}}) {
    options = expected(value, 2e-4);
    options.statistic = statistic;
    INFO(statistic);
    CHECK(Expectations::verdict(options, t, v).pass);
  }
}

TEST_CASE("errors are relative, absolute or one-sided as asked", "[app]") {
  const std::vector<double> t = {0, 1}, v = {0, 11};
  CHECK(Expectations::verdict(expected(10, 0.1), t, v).error == Approx(0.1));
  CHECK_FALSE(Expectations::verdict(expected(10, 0.09), t, v).pass);
  CHECK(Expectations::verdict(expected(10, 1, "absolute"), t, v).pass);
  CHECK_FALSE(Expectations::verdict(expected(10, 0.9, "absolute"), t, v).pass);
  CHECK(Expectations::verdict(expected(10, 0, "at_least"), t, v).pass);
  CHECK_FALSE(Expectations::verdict(expected(12, 0.5, "at_least"), t, v).pass);
  CHECK(Expectations::verdict(expected(12, 0, "at_most"), t, v).pass);
  CHECK_FALSE(Expectations::verdict(expected(10, 0, "at_most"), t, v).pass);
  CHECK_FALSE(Expectations::verdict(expected(10, 1e9), {0}, {std::nan("")}).pass);
  auto scaled = expected(22, 1e-12);
  scaled.factor = 2;
  CHECK(Expectations::verdict(scaled, t, v).pass);
}

TEST_CASE("along a line the mean absolute difference counts", "[app]") {
  ExpectationOptions options;
  options.values = {1, 2, 3};
  options.tolerance = 0.2;
  options.mode = "absolute";
  const auto verdict = Expectations::verdict_along(options, {1.3, 1.9, 3.2});
  CHECK(verdict.error == Approx(0.2));
  CHECK(verdict.computed == Approx(6.4 / 3));
  CHECK(verdict.expected == Approx(2));
  CHECK_FALSE(Expectations::verdict_along(options, {1.4, 1.9, 3.2}).pass);
  CHECK_FALSE(Expectations::verdict_along(options, {1, 2}).pass);  // other points than expected
  CHECK_FALSE(Expectations::verdict_along(options, {}).pass);
}

TEST_CASE("a shock stands where the quantity changes most steeply along the line", "[app]") {
  std::vector<double> pressure, speed, linear;
  for (int k = 0; k <= 100; ++k) {
    const double x = 0.01 * k;
    pressure.push_back(3 + 2 * std::tanh((x - 0.335) / 0.05) - 0.5 * x);
    speed.push_back(-pressure.back());
    linear.push_back(std::min(1.0, std::max(0.0, (x - 0.2) / 0.1)));  // one cell from 0.2 to 0.3
  }
  auto options = expected(0.335, 1e-9);
  options.statistic = "steepest_rise";
  CHECK(Expectations::verdict_along(options, pressure, 0.01).pass);
  options.factor = 1000;  // in mm
  options.value = 335;
  CHECK(Expectations::verdict_along(options, pressure, 0.01).pass);
  options = expected(0.335, 1e-9);
  options.statistic = "steepest_fall";
  CHECK(Expectations::verdict_along(options, speed, 0.01).pass);
  options.value = 0.25;
  options.statistic = "steepest_rise";
  CHECK(Expectations::verdict_along(options, linear, 0.01).pass);
  options.statistic = "steepest_fall";  // it falls nowhere: no place is no pass
  CHECK_FALSE(Expectations::verdict_along(options, linear, 0.01).pass);
}

TEST_CASE("the place of the largest and of the least value along a line", "[app]") {
  const std::vector<double> mach = {1, 1.7, 2.9, 3.6, 1.2, 0.9, 2, 1.6};
  auto options = expected(0.75, 1e-12);  // mm: the fourth of points 0.25 mm apart
  options.factor = 1000;
  options.statistic = "place_of_maximum";
  CHECK(Expectations::verdict_along(options, mach, 0.25e-3).pass);
  options.statistic = "place_of_minimum";
  CHECK_FALSE(Expectations::verdict_along(options, mach, 0.25e-3).pass);
  options.value = 1.25;
  CHECK(Expectations::verdict_along(options, mach, 0.25e-3).pass);
  CHECK_FALSE(Expectations::verdict_along(options, {2, 2, 2}, 0.25e-3).pass);  // nowhere more than elsewhere
}

TEST_CASE("an expectation that cannot be judged is refused before the run", "[app]") {
  CHECK(refusal({{"quantity", "pressure_drop"}, {"value", "3"}, {"tolerance", "0.1"}}).empty());
  CHECK(refusal({{"quantity", "presure_drop"}, {"value", "3"}, {"tolerance", "0.1"}})
            .find("did you mean pressure_drop?") != std::string::npos);
  CHECK(refusal({{"quantity", "pressure_drop"}, {"value", "3"}}).find("tolerance") != std::string::npos);
  CHECK_FALSE(refusal({{"quantity", "pressure_drop"}, {"tolerance", "0.1"}}).empty());
  CHECK_FALSE(refusal({{"quantity", "pressure_drop"}, {"values", "1,2"}, {"tolerance", "0.1"}}).empty());
  CHECK_FALSE(refusal({{"quantity", "pressure_drop"}, {"value", "0"}, {"tolerance", "0.1"}}).empty());
  CHECK_FALSE(
      refusal({{"quantity", "pressure_drop"}, {"value", "1"}, {"tolerance", "0.1"}, {"window", "2,1"}}).empty());
  CHECK_FALSE(
      refusal({{"quantity", "pressure_drop"}, {"value", "1"}, {"tolerance", "0.1"}, {"window", "1,2"}, {"at", "1"}})
          .empty());
  CHECK(refusal({{"quantity", "wall.velocity_x"}, {"values", "1,2"}, {"tolerance", "0.1"}}).empty());
  CHECK(refusal({{"quantity", "wall.velocity_x"}, {"value", "1"}, {"tolerance", "1"}, {"statistic", "steepest_rise"}})
            .empty());
  CHECK(
      refusal({{"quantity", "wall.velocity_x"}, {"value", "1"}, {"tolerance", "1"}, {"statistic", "place_of_maximum"}})
          .empty());
  CHECK(refusal({{"quantity", "pressure_drop"}, {"value", "1"}, {"tolerance", "1"}, {"statistic", "place_of_maximum"}})
            .find("not a quantity along a line") != std::string::npos);
  CHECK(refusal({{"quantity", "wall.velocity_x"}, {"value", "1"}, {"tolerance", "1"}, {"statistic", "frequency"}})
            .find("lies along a line") != std::string::npos);
  CHECK(refusal({{"quantity", "pressure_drop"}, {"value", "1"}, {"tolerance", "1"}, {"statistic", "steepest_rise"}})
            .find("not a quantity along a line") != std::string::npos);
}

TEST_CASE("what an expectation could not heed is refused instead of left out", "[app]") {
  const auto along = [](const std::string& name, const std::string& value, const std::string& expected = "value") {
    return refusal({{"quantity", "wall.velocity_x"}, {expected, "1"}, {"tolerance", "0.1"}, {name, value}});
  };
  CHECK(along("statistic", "maximum").empty());
  CHECK(along("statistic", "mean").empty());
  CHECK(along("at", "1").find("last output") != std::string::npos);
  CHECK(along("window", "1,2").find("last output") != std::string::npos);
  CHECK(along("statistic", "frequency").find("minimum") != std::string::npos);
  CHECK_FALSE(along("statistic", "maximum", "values").empty());
  CHECK_FALSE(
      refusal({{"quantity", "bed_height"}, {"value", "1"}, {"tolerance", "1"}, {"at", "1"}, {"statistic", "mean"}})
          .empty());
  Options options;
  options.set("expect_a_quantity", "inlet.pressure");
  options.set("expect_a_value", "1");
  options.set("expect_a_tolerance", "1");
  CHECK_NOTHROW(Expectations(options, {"inlet.pressure"}, {}));
  // A boundary and a probe, or a probe and a line, of the same name.
  CHECK_THROWS_WITH(Expectations(options, {"inlet.pressure", "inlet.pressure"}, {}), Catch::Contains("two things"));
  CHECK_THROWS_WITH(Expectations(options, {"inlet.pressure"}, {"inlet.pressure"}), Catch::Contains("two things"));
}

TEST_CASE("a history that is not a number somewhere has no extreme that could pass", "[app]") {
  const std::vector<double> t = {0, 1, 2}, v = {1, std::nan(""), 2};
  for (const char* statistic : {"minimum", "maximum", "amplitude", "mean"}) {
    auto options = expected(1, 10);
    options.statistic = statistic;
    INFO(statistic);
    CHECK_FALSE(Expectations::verdict(options, t, v).pass);
    if (std::string(statistic) != "amplitude") CHECK_FALSE(Expectations::verdict_along(options, v).pass);
  }
}

TEST_CASE("the verdicts of a run are written with their sources", "[app][mpi]") {
  TemporaryDirectory folder;
  OutputOptions output;
  output.directory = folder / "run";
  OutputDirectory directory(output);
  directory.prepare("");
  Options options;
  options.set("expect_height_quantity", "bed_height", "inputs/heap.yaml:7");
  options.set("expect_height_value", "0.03");
  options.set("expect_height_tolerance", "0.01");
  options.set("expect_height_source", "Mueller et al., \"2008\"");
  MeshOptions box;
  box.cells = {2, 2, 2};
  const Mesh mesh(box);
  Expectations expectations(options, {"bed_height"}, {});
  Quantities quantities;
  quantities.set("bed_height", 0.0302);
  expectations.sample(1.0, quantities);
  CHECK(expectations.judge(directory, Probes(mesh, options, nullptr), Profiles(mesh, options, true)));
  std::ifstream in(directory.path("expectations.csv"));
  std::stringstream text;
  text << in.rdbuf();
  CHECK(text.str().find("heap,height,bed_height,0.03,0.0302,") != std::string::npos);
  CHECK(text.str().find("PASS,\"Mueller et al., \"\"2008\"\"\"") != std::string::npos);
  quantities.set("bed_height", 0.04);
  expectations.sample(2.0, quantities);
  MPI_Barrier(PETSC_COMM_WORLD);
  CHECK_FALSE(expectations.judge(directory, Probes(mesh, options, nullptr), Profiles(mesh, options, true)));
}

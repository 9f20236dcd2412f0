#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "base/expression.hpp"
#include "base/options.hpp"
#include "base/petsc.hpp"
#include "base/solver_defaults.hpp"

using namespace silt;

namespace {

struct Sample {
  double density = 1000;
  int count = 3;
  bool verbose = false;
  std::string kind = "round";
  Vec3 velocity = Vec3::Zero();
  std::vector<double> list;
  std::optional<double> extra;
  void options(OptionGroup& option) {
    option("density", density, "kg/m3", "density", positive);
    option("count", count, "-", "how many", at_least(1));
    option("verbose", verbose, "talk");
    option("kind", kind, {"round", "square"}, "shape");
    option("velocity", velocity, "m/s", "velocity");
    option("list", list, "m", "lengths", positive);
    option("extra", extra, "Pa", "something else");
  }
};

/// Makes an empty folder of its own the working folder, so that tests leave nothing behind where they are run.
struct ScratchFolder {
  std::filesystem::path before = std::filesystem::current_path(), folder;
  ScratchFolder() : folder(std::filesystem::temp_directory_path() / ("silt_options_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder);
    std::filesystem::current_path(folder);
  }
  ~ScratchFolder() {
    std::filesystem::current_path(before);
    std::filesystem::remove_all(folder);
  }
};

std::string refusal(const std::string& name, const std::string& value) {
  Options options;
  options.set(name, value);
  Sample sample;
  try {
    options.read("sample", sample);
    options.refuse_unknown();
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("A given option fills its member, another keeps its default") {
  Options options;
  options.set("sample_density", "7.8e3");
  options.set("sample_velocity", "1, -2, 3e-1");
  options.set("sample_list", "1,2,3");
  options.set("sample_verbose", "yes");
  Sample sample;
  options.read("sample", sample);
  CHECK(sample.density == 7800);
  CHECK(sample.count == 3);
  CHECK(sample.verbose);
  CHECK(sample.velocity == Vec3(1, -2, 0.3));
  CHECK(sample.list == std::vector<double>{1, 2, 3});
  CHECK(!sample.extra);
}

TEST_CASE("A wrong value names option, value, unit and range") {
  CHECK(refusal("sample_density", "-1") ==
        "option -sample_density (command line): '-1' is not allowed; it must be a number in kg/m3 > 0");
  CHECK(refusal("sample_density", "1.2xyz").find("1.2xyz") != std::string::npos);
  CHECK(refusal("sample_density", "nan").find("nan") != std::string::npos);
  CHECK(refusal("sample_count", "1.5").find("whole number") != std::string::npos);
  CHECK(refusal("sample_kind", "roumd").find("did you mean round?") != std::string::npos);
  CHECK(refusal("sample_velocity", "1,2").find("three numbers") != std::string::npos);
  CHECK(refusal("sample_verbose", "maybe").find("yes or no") != std::string::npos);
}

TEST_CASE("An unknown option is refused with the nearest known one") {
  CHECK(refusal("sample_densty", "1").find("did you mean -sample_density?") != std::string::npos);
  CHECK(refusal("zzzzzzzzzzz", "1").find("-help") != std::string::npos);
}

TEST_CASE("Later files win over earlier ones and the command line over both; errors quote file and line") {
  const ScratchFolder scratch;
  std::ofstream("options_a.yaml") << "sample:\n  density: 1\n  count: 7\n";
  std::ofstream("options_b.yaml") << "sample: {density: 2, list: [1.0, 2.0]}\n";
  Options options = Options::from_arguments({"options_a.yaml", "-check", "options_b.yaml", "-sample_count", "9"});
  Sample sample;
  options.read("sample", sample);
  CHECK(sample.density == 2);
  CHECK(sample.count == 9);
  CHECK(sample.list.size() == 2);
  CHECK(options.given("check"));
  CHECK(options.origin("sample_density") == "options_b.yaml:1");
  CHECK_THROWS_AS(Options::from_arguments({"missing.yaml"}), UserError);
  std::ofstream("options_c.yaml") << "a: [1, 2\nb: }";
  CHECK_THROWS_AS(Options::from_arguments({"options_c.yaml"}), UserError);
}

TEST_CASE("Names of the user's choice are found by the property that follows them") {
  Options options;
  options.set("material_glass_density", "2500");
  options.set("material_glass_bead_density", "2500");
  CHECK(options.names("material", {"density", "friction"}) == std::vector<std::string>{"glass", "glass_bead"});
  options.set("material_glass_densty", "1");
  CHECK_THROWS_WITH(options.names("material", {"density", "friction"}),
                    Catch::Contains("did you mean -material_glass_density?"));
}

TEST_CASE("Expressions know x, y, z, t and refuse nonsense") {
  const Expression f("f", "2*x + y*z - t");
  CHECK(f(Vec3(1, 2, 3), 4) == 4);
  CHECK(!f.constant());
  CHECK(Expression("f", "sin(pi/2)").constant());
  CHECK_THROWS_AS(Expression("f", "2*+"), UserError);
  CHECK_THROWS_AS(Expression("f", "2*q"), UserError);
  const VectorExpression v("v", "0, 0, 0.6*min(t/0.1, 1)");
  CHECK(v(Vec3::Zero(), 0.05)[2] == Approx(0.3));
  CHECK_THROWS_AS(VectorExpression("v", "0, 1"), UserError);
}

TEST_CASE("A formula that gives no number on one rank is told on all, with its place", "[mpi]") {
  const Expression f("wall_a_heat", "sqrt(x - 1)");
  CHECK(std::isnan(f(Vec3(0.5, 0, 0), 2)) == true);
  CHECK_THAT(Expression::check(),
             Catch::Contains("-wall_a_heat: 'sqrt(x - 1)'") && Catch::Contains("(0.5, 0, 0) m, t = 2 s"));
  CHECK(Expression::check().empty());
  if (mpi_rank() == mpi_size() - 1) f(Vec3(0.25, 0, 0), 0);
  CHECK_THAT(Expression::check(), Catch::Contains("(0.25, 0, 0)"));
  {
    const Expression::Trial trial;
    f(Vec3::Zero(), 0);
  }
  f(Vec3(2, 0, 0), 0);
  CHECK(Expression::check().empty());
}

TEST_CASE("An options file may build on another one, which it overrides") {
  const ScratchFolder scratch;
  std::ofstream("options_base.yaml") << "sample: {density: 1, count: 5}\n";
  std::ofstream("options_derived.yaml") << "sample: {density: 2}\ninclude: options_base.yaml\n";
  Options options = Options::from_arguments({"options_derived.yaml"});
  Sample sample;
  options.read("sample", sample);
  CHECK(sample.density == 2);
  CHECK(sample.count == 5);
  std::ofstream("options_loop.yaml") << "include: [options_loop.yaml]\n";
  CHECK_THROWS_AS(Options::from_arguments({"options_loop.yaml"}), UserError);
}

TEST_CASE("A file that is not in the working directory is looked for beside the options file that names it") {
  const ScratchFolder scratch;
  struct Source {
    InputFile file;
    void options(OptionGroup& option) { option("file", file, "a file"); }
  } source;
  std::filesystem::create_directory("cases");
  std::ofstream("cases/case.yaml") << "mesh: {file: channel.msh}\n";
  std::ofstream("cases/channel.msh") << "there\n";
  Options options = Options::from_arguments({"cases/case.yaml"});
  options.read("mesh", source);
  CHECK(source.file == "cases/channel.msh");
  std::ofstream("channel.msh") << "here\n";
  options.read("mesh", source);
  CHECK(source.file == "channel.msh");
}

TEST_CASE("An option of a feature that is off is let through when the catalogue knows it") {
  Options catalogue, options;
  catalogue.declare({"boundary_<name>_type", "word", "", "", "", "", "", false});
  options.set("boundary_z_min_type", "pressure");
  CHECK_NOTHROW(options.refuse_unknown(&catalogue));
  options.set("boundary_z_min_tipe", "pressure");
  CHECK_THROWS_AS(options.refuse_unknown(&catalogue), UserError);
}

TEST_CASE("A mistyped property of a named thing is answered with the property and the user's own name") {
  Options catalogue, options;
  catalogue.declare({"boundary_<name>_velocity", "text", "", "", "", "", "", false});
  catalogue.declare({"pair_<a>_<b>_rolling_friction", "number", "", "", "", "", "", false});
  const auto answer = [&] {
    try {
      options.refuse_unknown(&catalogue);
    } catch (const UserError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  options.set("boundary_z_min_velocty", "0");
  CHECK(answer().find("did you mean -boundary_z_min_velocity?") != std::string::npos);
  options = Options();
  options.set("pair_glass_wall_roling_friction", "0");
  CHECK(answer().find("did you mean -pair_glass_wall_rolling_friction?") != std::string::npos);
}

TEST_CASE("a solver's defaults give way to those of the next one and to what the user gave, in any order") {
  const auto value = [] {
    char text[16] = "";
    PetscOptionsGetString(nullptr, nullptr, "-a_default", text, sizeof text, nullptr);
    return std::string(text);
  };
  default_solver_option("-a_default", "1");
  CHECK(value() == "1");
  CHECK(!solver_option_given("-a_default"));
  default_solver_option("-a_default", "0");
  CHECK(value() == "0");
  PetscOptionsSetValue(nullptr, "-a_default", "2");
  default_solver_option("-a_default", "1");
  CHECK(value() == "2");
  CHECK(solver_option_given("-a_default"));
  PetscOptionsClearValue(nullptr, "-a_default");
}

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "particles/walls/stl_file.hpp"
#include "stl_writer.hpp"

using namespace silt;
using namespace silt::test;

namespace {

const std::string file = "silt_test_surface.stl";

std::string complaint(const std::vector<Triangle>& triangles, bool closed, bool binary = false) {
  write_stl(file, triangles, binary);
  try {
    check_stl(read_stl(file), closed, file);
  } catch (const UserError& error) {
    std::remove(file.c_str());
    return error.what();
  }
  std::remove(file.c_str());
  return "";
}

}  // namespace

TEST_CASE("An ASCII and a binary STL file of one box give the same facets", "[walls][stl]") {
  const auto box = box_triangles({-1, 0, 0.5}, {1, 2, 3});
  for (bool binary : {false, true}) {
    write_stl(file, box, binary);
    const auto facets = read_stl(file);
    REQUIRE(facets.size() == 12);
    for (std::size_t f = 0; f < 12; ++f)
      for (int k = 0; k < 3; ++k) CHECK((facets[f].corner[k] - box[f][k]).norm() < 1e-12);
    CHECK_NOTHROW(check_stl(facets, true, file));
  }
  std::remove(file.c_str());
}

TEST_CASE("What is wrong with an STL surface is told with the facet", "[walls][stl]") {
  const auto box = box_triangles({0, 0, 0}, {1, 1, 1});
  auto flat = box;
  flat[4][2] = 0.5 * (flat[4][0] + flat[4][1]);
  CHECK_THAT(complaint(flat, true), Catch::Contains("facet 5 is degenerate"));
  auto open = box;
  open.erase(open.begin() + 11);
  CHECK_THAT(complaint(open, true), Catch::Contains("open edge"));
  CHECK(complaint(open, false).empty());
  auto turned = box;
  std::swap(turned[6][0], turned[6][1]);
  CHECK_THAT(complaint(turned, true), Catch::Contains("facet 7 is inverted: 3 of its neighbours"));
  auto inward = box;
  for (auto& t : inward) std::swap(t[0], t[1]);
  CHECK_THAT(complaint(inward, true), Catch::Contains("inverted: the normals of a closed surface must point outwards"));
  auto twice = box;
  twice.push_back(box[3]);
  CHECK_THAT(complaint(twice, false), Catch::Contains("facet 13 is facet 4 once more"));
  auto crossing = box;
  for (const auto& t : box_triangles({0.5, 0.3, 0.2}, {1.5, 0.6, 0.4})) crossing.push_back(t);
  CHECK_THAT(complaint(crossing, true), Catch::Contains("crosses facet"));
}

TEST_CASE("A file that is no STL file is refused with its fault", "[walls][stl]") {
  const auto refused = [](const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
    std::string said;
    try {
      read_stl(file);
    } catch (const UserError& error) {
      said = error.what();
    }
    std::remove(file.c_str());
    return said;
  };
  CHECK_THAT(refused("solid a\nfacet normal 0 0 x\n"), Catch::Contains(":2: 'x' where a number is expected"));
  CHECK_THAT(refused("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n"),
             Catch::Contains(":6: 'endloop' where vertex is expected"));
  CHECK_THAT(refused("solid a\nendsolid a\n"), Catch::Contains("no facets"));
  CHECK_THAT(refused(std::string(300, 'q')), Catch::Contains("no STL file"));
  CHECK_THROWS_WITH(read_stl("nowhere.stl"), Catch::Contains("does not exist"));
}

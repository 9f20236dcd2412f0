#include "base/series.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <numeric>

#include "base/error.hpp"

namespace silt {
namespace {

/// Place in our cell of each node in XDMF's order (tensor cells: around, ours are lexicographic).
std::vector<int> xdmf_order(Cell cell) {
  switch (cell) {
    case Cell::quadrilateral:
      return {0, 1, 3, 2};
    case Cell::hexahedron:
      return {0, 1, 3, 2, 4, 5, 7, 6};
    case Cell::triangle:
      return {0, 1, 2};
    case Cell::tetrahedron:
      return {0, 1, 2, 3};
  }
  return {};
}

const char* xdmf_name(Cell cell) {
  switch (cell) {
    case Cell::quadrilateral:
      return "Quadrilateral";
    case Cell::hexahedron:
      return "Hexahedron";
    case Cell::triangle:
      return "Triangle";
    case Cell::tetrahedron:
      return "Tetrahedron";
  }
  return "";
}

std::string data_item(const std::string& file, const std::string& dataset, long long rows, int components, bool whole,
                      int bytes) {
  return fmt::format(R"(<DataItem Format="HDF" NumberType="{}" Precision="{}" Dimensions="{}">{}:/{}</DataItem>)",
                     whole ? "Int" : "Float", bytes,
                     components == 1 ? fmt::format("{}", rows) : fmt::format("{} {}", rows, components), file, dataset);
}

std::string attribute(const std::string& name, const char* centre, int components, const std::string& item) {
  const char* type = components == 1   ? "Scalar"
                     : components == 3 ? "Vector"
                     : components == 6 ? "Tensor6"
                     : components == 9 ? "Tensor"
                                       : "Matrix";
  return fmt::format("    <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">{}</Attribute>\n", name, type,
                     centre, item);
}

void make_folder(const std::string& path) {
  int error = 0;
  if (mpi_rank() == 0) {
    std::error_code code;
    std::filesystem::create_directories(path, code);
    error = code.value();
  }
  MPI_Bcast(&error, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  if (error) throw RunError(fmt::format("cannot make {}: {}", path, std::generic_category().message(error)));
}

}  // namespace

SeriesIndex::SeriesIndex(std::string path, std::string name, std::optional<double> resumed)
    : path_(std::move(path)), name_(std::move(name)) {
  if (!resumed) return;
  if (mpi_rank() == 0) {
    std::ifstream file(path_);
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    const std::string first = "   <Grid Name=", last = "   </Grid>\n", time = "<Time Value=\"";
    for (std::size_t at = text.find(first); at != std::string::npos; at = text.find(first, at)) {
      const std::size_t end = text.find(last, at);
      if (end == std::string::npos) break;
      const std::string grid = text.substr(at, end + last.size() - at);
      const std::size_t value = grid.find(time);
      if (value != std::string::npos &&
          std::strtod(grid.c_str() + value + time.size(), nullptr) <= *resumed * (1 + 1e-9) + 1e-300)
        grids_.push_back(grid);
      at = end;
    }
  }
  int count = static_cast<int>(grids_.size());
  MPI_Bcast(&count, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  grids_.resize(static_cast<std::size_t>(count));  // only rank 0 needs the text
}

std::string SeriesIndex::next_file() const { return fmt::format("{}/{:06d}.h5", name_, grids_.size()); }

void SeriesIndex::add(double time, const std::string& body) {
  grids_.push_back(fmt::format(
      "   <Grid Name=\"{}\" GridType=\"Uniform\">\n    <Time Value=\"{:.15g}\"/>\n{}   </Grid>\n", name_, time, body));
  std::string text;
  if (mpi_rank() == 0) {
    text = fmt::format(
        "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n <Domain>\n"
        "  <Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"Temporal\">\n",
        name_);
    for (const auto& grid : grids_) text += grid;
    text += "  </Grid>\n </Domain>\n</Xdmf>\n";
  }
  write_text(path_, text);
}

FluidSeries::FluidSeries(const OutputDirectory& directory, const Mesh& mesh, const std::string& record)
    : mesh_(mesh),
      directory_(directory),
      index_(directory.path("fluid.xdmf"), "fluid", directory.resumed()),
      cellwise_(mesh.periodic[0] || mesh.periodic[1] || mesh.periodic[2]) {
  make_folder(directory.path("fluid"));
  if (index_.count() > 0) mesh_file_ = fmt::format("fluid/mesh_{}.h5", index_.count());
  const int corners = mesh.nodes_per_cell;
  const auto order = xdmf_order(mesh.cell);
  std::vector<std::int64_t> cells;
  cells.reserve(static_cast<size_t>(mesh.cells) * corners);
  long long cell_count = mesh.cells, first_cell = 0;
  MPI_Exscan(&cell_count, &first_cell, 1, MPI_LONG_LONG, MPI_SUM, PETSC_COMM_WORLD);
  if (mpi_rank() == 0) first_cell = 0;
  for (int c = 0; c < mesh.cells; ++c)
    for (int a = 0; a < corners; ++a)
      cells.push_back(cellwise_ ? (first_cell + c) * corners + order[a]
                                : mesh.node_global[mesh.cell_nodes[static_cast<size_t>(c) * corners + order[a]]]);
  const std::span<const double> points =
      cellwise_ ? std::span<const double>(mesh.cell_coordinates)
                : std::span<const double>(mesh.node_coordinates).first(3 * static_cast<size_t>(mesh.owned_nodes));
  const std::vector<std::int64_t> ranks(mesh.cells, mpi_rank());
  std::vector<Attribute> notes;
  if (!record.empty()) notes.push_back({"options", record});
  points_ = write_hdf5(directory.path(mesh_file_),
                       {{"points", 3, points},
                        {"cells", corners, std::span<const std::int64_t>(cells)},
                        {"rank", 1, std::span<const std::int64_t>(ranks)}},
                       notes)[0];
}

void FluidSeries::write(double time, const std::vector<NodeField>& fields) {
  const std::string file = index_.next_file();
  std::vector<std::vector<double>> per_cell;
  std::vector<Dataset> sets;
  for (const auto& field : fields) {
    const auto width = static_cast<size_t>(field.components);
    std::span<const double> values = field.values.first(width * static_cast<size_t>(mesh_.owned_nodes));
    if (cellwise_) {
      auto& copy = per_cell.emplace_back();
      copy.reserve(width * mesh_.cell_nodes.size());
      for (int node : mesh_.cell_nodes) {
        const auto at = field.values.subspan(width * static_cast<size_t>(node), width);
        copy.insert(copy.end(), at.begin(), at.end());
      }
      values = copy;
    }
    sets.push_back({field.name, field.components, values, directory_.single_precision()});
  }
  write_hdf5(directory_.path(file), sets, {{"time", time}});
  std::string body =
      fmt::format("    <Topology TopologyType=\"{}\" NumberOfElements=\"{}\">{}</Topology>\n", xdmf_name(mesh_.cell),
                  mesh_.total_cells, data_item(mesh_file_, "cells", mesh_.total_cells, mesh_.nodes_per_cell, true, 8)) +
      fmt::format("    <Geometry GeometryType=\"XYZ\">{}</Geometry>\n",
                  data_item(mesh_file_, "points", points_, 3, false, 8));
  for (const auto& set : sets)
    body += attribute(set.name, "Node", set.components,
                      data_item(file, set.name, points_, set.components, false, set.bytes()));
  body += attribute("rank", "Cell", 1, data_item(mesh_file_, "rank", mesh_.total_cells, 1, true, 8));
  index_.add(time, body);
}

ParticleSeries::ParticleSeries(const OutputDirectory& directory, std::string record)
    : directory_(directory),
      index_(directory.path("particles.xdmf"), "particles", directory.resumed()),
      record_(std::move(record)) {
  make_folder(directory.path("particles"));
}

void ParticleSeries::write(double time, std::vector<Dataset> arrays) {
  const std::string file = index_.next_file();
  for (auto& set : arrays) set.single_precision = directory_.single_precision();
  std::vector<Attribute> notes{{"time", time}};
  if (!record_.empty()) notes.push_back({"options", record_});
  // Explicit vertices: without them ParaView's newer XDMF readers see points but no cells to draw.
  long long mine = arrays.empty() ? 0 : static_cast<long long>(arrays[0].local_rows()), first = 0;
  MPI_Exscan(&mine, &first, 1, MPI_LONG_LONG, MPI_SUM, PETSC_COMM_WORLD);
  if (mpi_rank() == 0) first = 0;
  std::vector<std::int64_t> vertices(static_cast<size_t>(mine));
  std::iota(vertices.begin(), vertices.end(), first);
  arrays.push_back({"vertex", 1, std::span<const std::int64_t>(vertices)});
  const auto rows = write_hdf5(directory_.path(file), arrays, notes);
  std::string topology, geometry, attributes;
  for (size_t k = 0; k < arrays.size(); ++k) {
    const auto& set = arrays[k];
    const std::string item = data_item(file, set.name, rows[k], set.components, set.whole_numbers(), set.bytes());
    if (set.name == "position")
      geometry = item;
    else if (set.name == "vertex")
      topology = item;
    else
      attributes += attribute(set.name, "Node", set.components, item);
  }
  index_.add(time,
             fmt::format("    <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" NodesPerElement=\"1\">{}"
                         "</Topology>\n    <Geometry GeometryType=\"XYZ\">{}</Geometry>\n",
                         rows.back(), topology, geometry) +
                 attributes);
}

}  // namespace silt

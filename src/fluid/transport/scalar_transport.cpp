#include "fluid/transport/scalar_transport.hpp"

#include <algorithm>

#include "fluid/assembly/flow_table.hpp"

namespace silt {

ScalarTransport::ScalarTransport(const Mesh& mesh, const std::string& prefix, int table_order)
    : mesh_(mesh),
      order_(table_order),
      graph_(mesh),
      system_(graph_, prefix),
      kernel_(transport_kernel(mesh.cell)),
      cell_size_(shortest_edges(mesh)) {}

int ScalarTransport::points() const { return flow_table(mesh_.cell, order_).points; }

void ScalarTransport::assemble(TransportData data) {
  data.table = &flow_table(mesh_.cell, order_);
  data.nodes = mesh_.cell_nodes.data();
  data.coordinates = mesh_.cell_coordinates.data();
  data.cell_size = cell_size_.data();
  const size_t n = mesh_.nodes_per_cell;
  std::vector<double> K(kernel_.lanes * n * n), r(kernel_.lanes * n);
  system_.zero();
  auto &values = system_.matrix().values, &right = system_.right();
  for (int first = 0; first < mesh_.cells; first += kernel_.lanes) {
    const int count = std::min(kernel_.lanes, mesh_.cells - first);
    kernel_.assemble(data, first, count, K.data(), r.data());
    const int* entry = &graph_.cell_entry[static_cast<size_t>(first) * n * n];
    for (size_t k = 0; k < count * n * n; ++k) values[entry[k]] += K[k];
    const int* node = &mesh_.cell_nodes[static_cast<size_t>(first) * n];
    for (size_t k = 0; k < count * n; ++k) right[node[k]] += r[k];
  }
  mesh_.sum_shared(right.data(), 1);
}

void ScalarTransport::add_at_nodes(const std::vector<double>& coefficient, const std::vector<double>& right) {
  for (int i = 0; i < mesh_.owned_nodes; ++i) system_.matrix().values[graph_.diagonal[i]] += coefficient[i];
  for (int i = 0; i < mesh_.nodes; ++i) system_.right()[i] += right[i];
}

}  // namespace silt

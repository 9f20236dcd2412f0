#include "fluid/assembly/flow_nodes.hpp"

#include <algorithm>

#include "fluid/assembly/flow_system.hpp"

namespace silt {
namespace {

bool any_of_node(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double v) { return v != 0; });
}

}  // namespace

void FlowNodes::pack(const StepFields& fields, const double* state, const FlowLayout& layout, int dimension) {
  constexpr int stride = FlowData::node_stride, vertex_stride = FlowData::vertex_stride;
  const size_t nodes = fields.alpha.size(), vertices = fields.alpha_rate.size();
  forced_ = any_of_node(fields.body);
  const bool lent = !fields.lent_share.empty();
  loaded_ = any_of_node(fields.response) || any_of_node(fields.load) || any_of_node(fields.following) ||
            any_of_node(fields.lent_share);
  nodes_.resize(nodes * stride);
  vertices_.resize(vertices * vertex_stride);
  for (size_t i = 0; i < nodes; ++i) {
    double* to = &nodes_[i * stride];
    const double* u = state + static_cast<size_t>(layout.velocity_stride) * i;
    for (int c = 0; c < 3; ++c) {
      to[c] = c < dimension ? u[c] : 0;
      to[4 + c] = fields.history[3 * i + c];
      if (forced_) to[8 + c] = fields.body[3 * i + c];
      if (loaded_) to[12 + c] = fields.velocity_old[3 * i + c];
    }
    to[3] = fields.alpha[i];
  }
  for (size_t i = 0; i < vertices; ++i) {
    double* to = &vertices_[i * vertex_stride];
    to[0] = state[layout.pressure_offset + static_cast<size_t>(layout.pressure_stride) * i];
    to[1] = fields.alpha_rate[i];
    if (!loaded_) continue;
    to[2] = fields.response[i];
    to[3] = fields.following.empty() ? 0 : fields.following[i];
    to[8] = lent ? fields.lent_share[i] : 0;
    to[9] = lent ? fields.lent_pressure[i] : 0;
    for (int c = 0; c < 3; ++c) to[4 + c] = fields.load[3 * i + c];
  }
}

void FlowNodes::give(FlowData& data) const {
  data.node_values = nodes_.data();
  data.vertex_values = vertices_.data();
  data.forced = forced_;
  data.loaded = loaded_;
}

}  // namespace silt

#pragma once
#include <string>
#include <vector>

#include "base/checkpoint_file.hpp"
#include "base/mesh.hpp"
#include "fluid/fluid.hpp"

namespace silt {

/// Adds arrays on the nodes and cells of the mesh to a checkpoint, as `<prefix>_<name>`, and where nodes and cells are.
/// Collective.
void save_fields(const Mesh& mesh, const std::string& prefix, const std::vector<Fluid::StateArray>& arrays,
                 CheckpointWriter& to);

/// Fills the arrays from a checkpoint of the same mesh in whatever partition: nodes and cells are told by their place.
/// Throws UserError on every rank for one of another mesh or with other arrays. Collective.
void load_fields(const Mesh& mesh, const std::string& prefix, const std::vector<Fluid::StateArray>& arrays,
                 const CheckpointReader& from);

}  // namespace silt

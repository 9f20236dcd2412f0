#pragma once
#include <array>
#include <string>
#include <vector>

#include "app/moment.hpp"
#include "app/ring_share.hpp"
#include "base/checkpoint_file.hpp"
#include "base/mesh.hpp"
#include "base/output_directory.hpp"

namespace silt {

/// `-profile_<name>_...`: boxes along a line, or rings about an axis, over which the particles are averaged in space
/// and time.
struct ProfileOptions {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero(), size = Vec3::Zero(), centre = Vec3::Zero();
  std::string axis = "none";
  int points = 20;
  double start = 0;
  void options(OptionGroup& option);
};

/// Averages of the particles in boxes or rings, from the spheres themselves: `profile_<name>.csv`, rewritten at every
/// output.
///
/// The void fraction of a box is 1 - (volume of the spheres inside it)/(volume of the box within the mesh's bounding
/// box); a sphere that the box cuts counts with the part inside, found by 512 points of equal volume, and one that lies
/// across a periodic side counts on both. A ring is cut exactly and taken whole, also where it reaches beyond the mesh
/// across its axis. Velocities are means by volume over boxes and time.
class Profiles {
 public:
  Profiles(const Mesh& mesh, Options& options, bool with_particles);
  /// Adds the present state, weighted with the step's length, to the averages. Local.
  void sample(const Moment& moment);
  /// Takes over the averages of another one of the same options. Local.
  void inherit(const Profiles& other) { items_ = other.items_; }
  /// Puts the averages so far into a checkpoint, and goes on from those of one (of profiles of the same name and number
  /// of boxes). Collective.
  void save(CheckpointWriter& to) const;
  void load(const CheckpointReader& from);
  /// Writes the averages so far. Collective.
  void write(const OutputDirectory& directory);
  /// `<profile>.<column>` of every profile.
  std::vector<std::string> columns() const;
  /// The averages along a profile as last written; empty when there is no such `<profile>.<column>`.
  std::vector<double> values(const std::string& column) const;
  /// m between the boxes or rings of that profile; 0 when there is none.
  double spacing(const std::string& column) const;

 private:
  struct Box {
    Vec3 centre, lower, upper;
    double volume;
    Ring ring;
  };
  struct Item {
    std::string name;
    double start;
    int axis;  ///< of rings; -1: boxes
    Vec3 origin;
    std::vector<Box> boxes;
    std::vector<double> sums;   ///< [boxes][4] this rank's int (volume, volume velocity) dt
    double time = 0;            ///< s averaged over
    std::vector<double> means;  ///< [boxes][4] void fraction, velocity
  };
  static double share(const Item& item, const Box& box, const Vec3& centre, double radius);
  /// A sphere's place and those of its images across the periodic sides that it reaches beyond; how many there are.
  int images(const Vec3& centre, double radius, std::array<Vec3, 8>& places) const;
  static void make_ring(const Mesh& mesh, const ProfileOptions& profile, const Item& item, Box& box);
  std::vector<Item> items_;
  Vec3 lower_, upper_;  ///< m, of the mesh
  std::array<bool, 3> periodic_;
};

/// Share of a sphere's volume that lies in the box [lower, upper].
double share_in_box(const Vec3& centre, double radius, const Vec3& lower, const Vec3& upper);

}  // namespace silt

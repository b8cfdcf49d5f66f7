// What a result is judged against.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "eval/signed_distance.h"

namespace photohull::eval {

/// The exact surface, and points on it with what the cameras see of them.
class Truth {
 public:
  /// A surface all of which counts. Throws Error when it has no face with an area or its bounds
  /// have no size.
  explicit Truth(TriMesh surface);
  /// The same with area-uniform `samples` of the surface, world, and the number of cameras that
  /// see each. Throws Error when their numbers differ or there are none.
  Truth(TriMesh surface, std::vector<glm::dvec3> samples, std::vector<std::uint8_t> views);

  const TriMesh& mesh() const { return mesh_; }
  const SignedDistance& surface() const { return surface_; }
  /// Length of the diagonal of the box of all vertices, world units; > 0.
  double diagonal() const { return diagonal_; }
  /// Is it known what the cameras see?
  bool has_views() const { return !samples_.empty(); }
  const std::vector<glm::dvec3>& samples() const { return samples_; }
  const std::vector<std::uint8_t>& views() const { return views_; }

  std::string name;  ///< for people: where it comes from
  std::string note;  ///< which surface counts, and why

 private:
  TriMesh mesh_;
  SignedDistance surface_;
  double diagonal_ = 0;
  std::vector<glm::dvec3> samples_;
  std::vector<std::uint8_t> views_;
};

/// Reads the truth of a scene, a folder with
///
///   gt.ply          the surface
///   gt_visible.ply  area-uniform samples of it with the vertex property `views`, the number of
///                   cameras that see each; without this file all surface counts
///
/// or a mesh file (read_mesh), all of which counts. Throws Error naming the file and what is
/// missing or wrong.
Truth read_truth(const std::filesystem::path& path);

}  // namespace photohull::eval

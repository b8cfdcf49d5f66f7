// What a result is judged against.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "eval/signed_distance.h"

namespace photohull::eval {

class NearestSample;

/// The exact surface, or points on it, and samples with what the cameras see of them.
class Truth {
 public:
  /// A surface all of which counts; without faces points of one, as scanners give them. Throws
  /// Error when no face has an area, where there are any, or its bounds have no size.
  explicit Truth(TriMesh surface);
  /// The same with area-uniform `samples` of the surface, world, and the number of cameras that
  /// see each. Throws Error when their numbers differ or there are none.
  Truth(TriMesh surface, std::vector<glm::dvec3> samples, std::vector<std::uint8_t> views);

  ~Truth();
  Truth(Truth&&) noexcept;
  Truth& operator=(Truth&&) noexcept;

  const TriMesh& mesh() const { return mesh_; }
  /// No surface, but points of one: distances are to the nearest, and have no sign.
  bool is_points() const { return !surface_; }
  /// Not of points.
  const SignedDistance& surface() const { return surface_.value(); }
  /// From the nearest point of the surface, or the nearest of the points; world units.
  double distance(const glm::dvec3& p) const;
  /// Of points: how far the nearest other one is, the median over some; world units. Distances
  /// below that tell nothing.
  double spacing() const { return spacing_; }
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
  std::optional<SignedDistance> surface_;
  std::unique_ptr<NearestSample> points_;  ///< where there is no surface
  double diagonal_ = 0, spacing_ = 0;
  std::vector<glm::dvec3> samples_;
  std::vector<std::uint8_t> views_;
};

/// Reads the truth of a scene, a folder with
///
///   gt.ply          the surface
///   gt_visible.ply  area-uniform samples of it with the vertex property `views`, the number of
///                   cameras that see each; without this file all surface counts
///
/// or a file of a mesh or of points (read_mesh), all of which counts. Throws Error naming the file
/// and what is missing or wrong.
Truth read_truth(const std::filesystem::path& path);

}  // namespace photohull::eval

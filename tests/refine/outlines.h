// A ball's silhouettes, and meshes that stand against them.
#pragma once

#include <vector>

#include "carving/hull.h"
#include "support/analytic_volumes.h"
#include "support/cameras.h"
#include "support/silhouettes.h"
#include "volume/extract_mesh.h"

namespace photohull::refine {

inline const glm::dvec3 kCentre(15.5, 15.5, 15.5);
inline constexpr double kRadius = 10;

/// What cameras all around see of a ball of kRadius voxels about kCentre.
class BallViews {
 public:
  explicit BallViews(std::vector<Camera> cameras, bool likelihood = false)
      : cameras_(std::move(cameras)) {
    for (const Camera& camera : cameras_)
      outlines_.push_back(test::sphere_outline(camera, kCentre, kRadius));
    for (const test::Outline& outline : outlines_)
      silhouettes_.push_back({&outline.mask, &outline.distance, nullptr, likelihood});
  }
  explicit BallViews(int count)
      : BallViews(test::cameras_around(kCentre, 60, count, 150, 100, 100)) {}

  const std::vector<Camera>& cameras() const { return cameras_; }
  const std::vector<carving::Silhouette>& silhouettes() const { return silhouettes_; }

 private:
  std::vector<Camera> cameras_;
  std::vector<test::Outline> outlines_;
  std::vector<carving::Silhouette> silhouettes_;
};

/// A volume's surface, in voxels.
struct Surface {
  explicit Surface(const Distance& distance)
      : volume(sample_volume({4, 4, 4}, distance)), mesh(extract_mesh(volume)) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
      positions.emplace_back((mesh.world(i) - volume.grid.origin) / volume.grid.voxel_size);
  }
  SparseVolume volume;
  TriMesh mesh;
  std::vector<glm::vec3> positions;
};

}  // namespace photohull::refine

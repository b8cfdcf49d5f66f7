// A textured bowl whose hollow no silhouette shows.
#pragma once

#include <vector>

#include "carving/hull.h"
#include "core/mesh.h"
#include "core/prepared_view.h"
#include "support/ray_cast.h"

namespace photohull::test {

/// Signed distance from the bowl (a lower bound outside), world units: what of a ball of radius 0.8
/// about the origin lies below z = 0.2, without a ball of radius 0.55 about (0, 0, 0.25).
double bowl(const glm::dvec3& p);
/// The same with the hollow filled: all that silhouettes can tell.
double filled_bowl(const glm::dvec3& p);

/// Photographs from two rings of cameras above and one below, with the bowl's silhouettes.
struct BowlScene {
  std::vector<PreparedView> views;  ///< with masks
  std::vector<Camera> cameras;
  std::vector<SilhouetteDistance> distances;
  Box box{glm::dvec3(-0.95), glm::dvec3(0.95)};

  /// One a view; without masks their parts are empty.
  std::vector<carving::Silhouette> silhouettes(bool masks = true) const;
  /// `edge` bricks along each side, a little larger than the box.
  GridSpec grid(int edge) const;
  SparseVolume hull(const GridSpec& grid, bool masks = true) const;
};

/// Made once a process.
const BowlScene& bowl_scene();

/// Mean distance in voxels between a volume's surface and the bowl's, over the mesh's vertices.
double mean_error(const SparseVolume& volume);

}  // namespace photohull::test

// The visual hull from silhouettes, coarse to fine on sparse bricks [Laurentini94].
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/grid.h"
#include "core/image.h"
#include "core/progress.h"
#include "core/silhouette.h"
#include "gpu/context.h"

namespace photohull::carving {

/// What a view's silhouette says. Views without a mask have empty parts: they bound the volume by
/// their frustum only.
struct Silhouette {
  const Mask* mask = nullptr;
  const SilhouetteDistance* distance = nullptr;
  const std::vector<LinePoint>* lines = nullptr;  ///< of the mask before they were widened
  /// Coverage is the chance that the object is there (masks that were made), not the share of a
  /// pixel.
  bool likelihood = false;
  const ColourImage* image = nullptr;  ///< tells what was photographed; nullptr: all was
};

struct HullOptions {
  /// Cameras that must have a point on their image for it to stand (>= 1). With silhouettes one is
  /// enough; without, space seen by fewer than two cameras can never be judged and is dropped.
  int min_views = 1;
  /// Silhouettes that may leave a point out and it stands all the same (0 to kMostMissing): for
  /// cameras, masks or wind that are off in some views. Views that do not have the point on their
  /// image say nothing and do not count.
  int views_may_miss = 0;
  static constexpr int kMostMissing = 16;
  /// Pixels outside its outline at which one view's evidence against a point is full; for
  /// points nearer to the outline it rises with the distance. A point goes when the evidence of all
  /// views sums to one. 0: any view rejects a point at once. By what outlines disagree; not
  /// together with views_may_miss.
  double full_evidence = 0;
};

struct HullReport {
  std::int64_t nodes_tested = 0;
  std::int64_t bricks_evaluated = 0;
  std::int64_t samples = 0;  ///< upper bound of silhouette look-ups
};

/// Where a hull is taken.
struct HullSpace {
  GridSpec grid;
  Box box;  ///< world coordinates, inside the grid: nothing stands outside of it
};

/// What it is taken from; both in the same order.
struct HullViews {
  std::span<const Camera> cameras;
  std::span<const Silhouette> silhouettes;
};

class SilhouetteTextures;

/// Truncated signed distance to the intersection of box, silhouette cones and (for min_views > 1)
/// frusta. When nothing is left the volume is empty.
SparseVolume carve_silhouette(gpu::Context& context, const HullSpace& space, const HullViews& views,
                              const HullOptions& options, Progress& progress,
                              HullReport* report = nullptr);
/// The same of silhouettes that are on the device already, for several hulls of them.
SparseVolume carve_silhouette(gpu::Context& context, const HullSpace& space,
                              const SilhouetteTextures& silhouettes, const HullOptions& options,
                              Progress& progress, HullReport* report = nullptr);

namespace reference {

enum class NodeClass { kOutside, kInside, kSurface };

/// A cube of `edge` voxels from corner `low` (voxel coordinates), grown by `margin`.
struct NodeCube {
  glm::ivec3 low{0};
  int edge = 0;
  double margin = 0;  ///< voxels
};

/// What the node is, by looking at every pixel that its projection touches; double precision.
NodeClass classify_node(const HullSpace& space, const HullViews& views, const HullOptions& options,
                        const NodeCube& node);

/// Signed distance in voxels at one voxel, clamped to the band; double precision.
double hull_distance(const HullSpace& space, const HullViews& views, const HullOptions& options,
                     const glm::ivec3& voxel);

}  // namespace reference
}  // namespace photohull::carving

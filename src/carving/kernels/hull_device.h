// The two kernels of the visual hull (carving_classify_nodes.comp.glsl,
// carving_hull_distance.comp.glsl).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "carving/hull.h"
#include "carving/silhouette_textures.h"
#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/program.h"
#include "projtex/device_views.h"

namespace photohull::carving {

/// Voxels by which nodes are grown when they are classified: keeps both ends of every sign change
/// among the bricks.
inline constexpr float kSplitMargin = 1.0f;

/// A cube of 2^level bricks a side.
struct HullNode {
  glm::ivec3 place{0};  ///< in its own edges
  int level = 0;
};

/// What nodes are; those outside are gone.
struct ClassifiedNodes {
  std::vector<HullNode> surface;        ///< to split or, at level 0, bricks to evaluate
  std::vector<std::uint32_t> relevant;  ///< bits of the views that matter to each of `surface`
  std::vector<std::uint8_t> unsure;     ///< of `surface`: too few views show all of it
  std::vector<HullNode> inside;
};

class HullDevice {
 public:
  /// The silhouettes outlive it.
  HullDevice(gpu::Context& context, const HullSpace& space, const SilhouetteTextures& silhouettes,
             const HullOptions& options);

  /// In the order of the nodes, batch by batch (reference::classify_node).
  ClassifiedNodes classify(std::span<const HullNode> nodes) const;

  /// Bricks whose distances and lists of views fit into storage blocks.
  std::size_t brick_batch() const;
  /// kBrickVoxels distances in voxels for each of the bricks [first, first + count) of
  /// `bricks.surface`, all of level 0, not clamped to the band (reference::hull_distance).
  std::vector<float> distances(const ClassifiedNodes& bricks, std::size_t first,
                               std::size_t count) const;

 private:
  void classify_batch(std::span<const HullNode> nodes, ClassifiedNodes& out) const;
  /// The views that matter to each brick, as the kernel reads them.
  std::vector<std::uint32_t> view_lists(const ClassifiedNodes& bricks, std::size_t first,
                                        std::size_t count) const;
  /// Parameters of so many nodes or bricks, bound together with the views.
  gpu::Buffer bind_parameters(std::size_t items) const;

  gpu::Context& context_;
  HullSpace space_;
  const SilhouetteTextures& silhouettes_;
  HullOptions options_;
  int views_, words_;  ///< views, and words of a set of them
  projtex::DeviceViews device_views_;
  std::shared_ptr<const gpu::Program> classify_, distance_;
};

}  // namespace photohull::carving

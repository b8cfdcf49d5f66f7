// The kernels of the visual hull on their own, bound as carve_silhouette binds them.
#pragma once

#include <optional>
#include <vector>

#include "carving/hull.h"
#include "gpu/buffer.h"
#include "gpu/program.h"
#include "gpu/texture.h"
#include "projtex/device_views.h"
#include "shared/hull.h"
#include "support/silhouettes.h"

namespace photohull::carving::test_kernels {

/// Voxels by which distances may be off. Measured on llvmpipe: 1.3e-3, nearly all of it the half
/// floats' rounding of distances; beyond that what the device rounds when it filters along two
/// axes.
double distance_bound();

/// A scene to take a hull of.
struct HullScene {
  GridSpec grid;
  Box box;
  std::vector<Camera> cameras;
  std::vector<test::Outline> outlines;  ///< empty parts: the view has no mask
  HullOptions options;

  std::vector<Silhouette> silhouettes() const;
  double distance(const glm::ivec3& voxel) const;  ///< of the reference
};

class HullKernels {
 public:
  /// With the views as HullDevice has them: uniforms where they are few; or in a storage block.
  HullKernels(gpu::Context& context, const HullScene& scene, bool in_storage = false);

  /// shaders::kNode... of each node (xyz in its own edges; w: level).
  std::vector<std::uint32_t> classify(const std::vector<glm::ivec4>& nodes, float margin);
  /// kBrickVoxels distances a brick, all views considered.
  std::vector<float> distances(const std::vector<glm::ivec4>& bricks);

 private:
  void upload(int view, const test::Outline& outline);
  const char* defines() const { return in_storage_ ? "" : device_views_->defines(); }
  void bind_views() const;

  gpu::Context& context_;
  const HullScene& scene_;
  int words_;
  gpu::TextureArray pyramid_, distance_maps_;
  bool in_storage_;
  gpu::Buffer stored_views_;
  std::optional<projtex::DeviceViews> device_views_;
  shaders::HullParameters parameters_{};
};

}  // namespace photohull::carving::test_kernels

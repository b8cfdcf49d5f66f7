// What a viewpoint sees of a geometry, drawn once and asked for any number of receivers.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/program.h"
#include "gpu/texture.h"
#include "visibility/geometry.h"
#include "visibility/layout.h"
#include "visibility/technique.h"

namespace photohull::visibility {

/// A point whose visibility is asked.
struct Sample {
  glm::dvec3 position{0.0};             ///< world
  glm::dvec3 normal{0, 0, 1};           ///< unit; of Bias::kReceiverPlane and virtual samples
  glm::dvec3 step_x{0.0}, step_y{0.0};  ///< to its neighbours on the tangent plane: derivatives,
                                        ///< and kernels on pixels
  std::uint32_t id = shaders::kNoTriangle;  ///< triangle of the mesh, brick of the volume
};

/// Move-only. Keeps no reference to the viewpoint; sub-pixel maps keep their own triangles.
class VisibilityMap {
 public:
  const Technique& technique() const { return technique_; }
  const MapLayout& layout() const { return layout_; }
  std::size_t bytes() const;  ///< of textures and buffers
  /// Depths of the nearest surface (or the second), partitions one after another, row-major;
  /// +infinity where there is none. For tests and pictures.
  std::vector<float> depths(bool second = false) const;
  std::vector<std::uint32_t> ids() const;
  /// Detail::kLists: triangles of one texel, ascending. Others: up to kMaxLinks (kCoverage) or one.
  std::vector<std::uint32_t> triangles_at(gpu::Context& context, int part,
                                          const glm::ivec2& texel) const;
  /// Detail::kLists: length of all lists together.
  std::size_t linked() const { return linked_; }

  /// Binds what include/visibility_test.glsl reads, where shared/visibility.h says.
  void bind() const;

 private:
  friend class MapRenderer;
  friend class DetailRenderer;
  friend std::vector<float> visible(gpu::Context&, const VisibilityMap&, std::span<const Sample>);
  Technique technique_;
  MapLayout layout_;
  glm::dvec3 origin_{0.0};
  gpu::Buffer info_{sizeof(shaders::MapInfo)};
  gpu::TextureArray first_, second_, ids_, moments_;
  gpu::Buffer triangles_;  ///< sub-pixel maps
  gpu::Buffer list_ends_;  ///< a texel: where its list begins, or its nearest triangle
  gpu::Buffer list_;       ///< of all texels, one after another
  gpu::Buffer list_rest_;  ///< what goes beyond a storage block
  std::size_t linked_ = 0;
  std::shared_ptr<const gpu::Program> test_;
};

/// Draws a map. `eye`: the receivers' camera, for warps. Throws UsageError for options that do not
/// go together, Error when the device cannot hold the map.
VisibilityMap render_map(gpu::Context& context, const Camera& viewpoint, const Geometry& geometry,
                         const Technique& technique, const std::optional<Camera>& eye = {});

/// The share of each sample that the viewpoint sees, in [0, 1]; 0 behind it and off its image.
std::vector<float> visible(gpu::Context& context, const VisibilityMap& map,
                           std::span<const Sample> samples);

}  // namespace photohull::visibility

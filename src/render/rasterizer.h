// Private to module render: triangles to pictures through the GL pipeline.
#pragma once

#include <memory>

#include "core/mesh.h"
#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/program.h"
#include "render/choose_views.h"
#include "render/preview.h"
#include "visibility/kernels/visibility_map.h"

namespace photohull::render {

/// Background of all panels, sRGB.
inline constexpr std::uint8_t kBackground = 96;

struct Rendering {
  PreviewImage coloured;  ///< the vertices' colours as they are, unshaded
  PreviewImage clay;      ///< under a headlight and a side light, which casts shadows
};

/// A mesh on the device, drawn from any camera.
class Rasterizer {
 public:
  /// Throws Error when the device cannot hold the mesh.
  Rasterizer(gpu::Context& context, const TriMesh& mesh);
  ~Rasterizer();
  Rasterizer(const Rasterizer&) = delete;
  Rasterizer& operator=(const Rasterizer&) = delete;

  /// The window of the camera's image plane at width x height pixels, anti-aliased in linear light.
  /// Faces seen from behind are not drawn.
  Rendering draw(const Camera& camera, const Window& window, int width, int height);

 private:
  visibility::VisibilityMap side_light(const Camera& camera) const;

  gpu::Context& context_;
  visibility::Geometry geometry_;
  gpu::Buffer normals_, colours_;
  std::shared_ptr<const gpu::Program> program_;
  unsigned vertex_array_ = 0;
};

}  // namespace photohull::render

// Triangles to pictures through the GL pipeline.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/mesh.h"
#include "core/mesh_texture.h"
#include "core/rgb_image.h"
#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/program.h"
#include "gpu/texture.h"
#include "render/choose_views.h"
#include "visibility/kernels/visibility_map.h"

namespace photohull::render {

/// Background of all panels of the preview, sRGB.
inline constexpr std::uint8_t kBackground = 96;

using Colour = std::array<std::uint8_t, 3>;  ///< sRGB

enum class Look {
  kColours,  ///< of the texture, or else of the vertices, as they are, unshaded
  kClay      ///< under a headlight and a side light, which casts shadows
};

struct Rendering {
  RgbImage coloured, clay;
};

/// A mesh on the device, drawn from any camera.
class Rasterizer {
 public:
  /// With the vertices' colours; grey without. mesh.normals must be present. Throws Error when the
  /// device cannot hold the mesh.
  Rasterizer(gpu::Context& context, const TriMesh& mesh);
  /// With the texture, whose pages must be of one size. Throws Error when the device cannot hold
  /// it, too.
  Rasterizer(gpu::Context& context, const TexturedMesh& textured);
  ~Rasterizer();
  Rasterizer(const Rasterizer&) = delete;
  Rasterizer& operator=(const Rasterizer&) = delete;

  /// The window of the camera's image plane at width x height pixels, anti-aliased in linear light.
  /// Faces seen from behind are not drawn.
  Rendering draw(const Camera& camera, const Window& window, int width, int height);
  /// One of the two, before a background of that colour.
  RgbImage draw(const Camera& camera, const Window& window, int width, int height, Look look,
                const Colour& background);

 private:
  class Target;
  /// `colours` have `components` numbers a vertex: bytes where there are four, else floats.
  Rasterizer(gpu::Context& context, const TriMesh& mesh, gpu::Buffer colours, int components);
  void draw_into(const Target& target, const Camera& camera, const Window& window);
  visibility::VisibilityMap side_light(const Camera& camera) const;

  gpu::Context& context_;
  visibility::Geometry geometry_;
  gpu::Buffer normals_, colours_;
  gpu::TextureArray pages_;  // none without a texture
  std::shared_ptr<const gpu::Program> program_;
  unsigned vertex_array_ = 0;
};

}  // namespace photohull::render

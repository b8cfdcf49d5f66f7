// Images on the triangles of a mesh.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/mesh.h"
#include "core/rgb_image.h"

namespace photohull {

struct MeshTexture {
  std::vector<RgbImage> pages;
  std::vector<std::uint32_t> page;  ///< of each triangle
  /// Of each triangle's corners the place on its page, in [0, 1]: (0, 0) is the top-left corner of
  /// the page, (1, 1) its bottom-right one.
  std::vector<std::array<glm::vec2, 3>> corners;
};

struct TexturedMesh {
  TriMesh mesh;
  MeshTexture texture;
};

}  // namespace photohull

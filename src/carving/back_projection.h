// Masks projected back onto a dense lattice, voxel centre by voxel centre: what programs ask for
// that want the votes themselves, not a surface.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace photohull::carving {

/// Voxel (i, j, k) has its centre at origin + voxel_size * (i, j, k), and is the element
/// (i * shape.y + j) * shape.z + k of arrays.
struct DenseLattice {
  glm::ivec3 shape{0};
  glm::dvec3 origin{0.0};  ///< world
  double voxel_size = 0;   ///< world units

  std::size_t voxels() const {
    return std::size_t(shape.x) * std::size_t(shape.y) * std::size_t(shape.z);
  }
};

/// A camera whose pixel of a point x is that of K (R x + t) with its fractions cut off (towards
/// zero). Points behind it, and those whose pixel is not on the image, are not seen.
struct TruncatingCamera {
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< pixels
  glm::dmat3 rotation{1.0};               ///< cam_from_world
  glm::dvec3 translation{0.0};
};

/// Row-major pixels.
template <typename Pixel>
struct PixelView {
  std::span<const Pixel> pixels;
  int width = 0, height = 0;
};

/// What is known of each block of 8^3 voxels between the views of a carving; all zero at first.
std::vector<std::uint8_t> carving_blocks(const DenseLattice& lattice);

/// Labels of voxels that are seen and whose pixel is 0 become -1 and stay so; other labels of 0
/// become 1 where they are seen. The same as a loop over all voxels: blocks whose pixels are all
/// alike are settled at once.
void carve_dense(const DenseLattice& lattice, const TruncatingCamera& camera,
                 const PixelView<std::uint8_t>& mask, std::span<std::int32_t> labels,
                 std::span<std::uint8_t> blocks);

/// Adds to each voxel that is seen its pixel's value. Values are finite. Likewise.
void add_dense(const DenseLattice& lattice, const TruncatingCamera& camera,
               const PixelView<float>& image, std::span<float> sums);

}  // namespace photohull::carving

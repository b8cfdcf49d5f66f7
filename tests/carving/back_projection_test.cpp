#include "carving/back_projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace photohull::carving {
namespace {

constexpr int kWidth = 61, kHeight = 47;
const DenseLattice kLattice{{21, 34, 19}, {-0.9, -1.4, -0.8}, 0.087};

/// The pixel of a voxel, from the formulas; -1 where it is not seen.
int pixel_of(const TruncatingCamera& c, int i, int j, int k) {
  const glm::dvec3 x = kLattice.origin + kLattice.voxel_size * glm::dvec3(i, j, k);
  const glm::dvec3 p = c.rotation * x + c.translation;
  if (p.z <= 0) return -1;
  const double u = std::trunc(p.x / p.z * c.fx + c.cx), v = std::trunc(p.y / p.z * c.fy + c.cy);
  if (u < 0 || u > kWidth - 1 || v < 0 || v > kHeight - 1) return -1;
  return int(v) * kWidth + int(u);
}

TruncatingCamera some_camera(std::mt19937& random, double distance) {
  std::normal_distribution<double> normal;
  const glm::dvec3 a = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
  const glm::dvec3 b =
      glm::normalize(glm::cross(a, glm::dvec3(normal(random), normal(random), normal(random))));
  return {55.3, 52.1, 30.2, 22.9, glm::dmat3(a, b, glm::cross(a, b)), {0.1, -0.2, distance}};
}

/// Calls what(voxel's index, i, j, k).
template <typename What>
void for_voxels(const What& what) {
  std::size_t voxel = 0;
  for (int i = 0; i < kLattice.shape.x; ++i)
    for (int j = 0; j < kLattice.shape.y; ++j)
      for (int k = 0; k < kLattice.shape.z; ++k) what(voxel++, i, j, k);
}

/// Large areas of one value, in which blocks lie as a whole, and single pixels.
template <typename Pixel>
std::vector<Pixel> some_pixels(std::mt19937& random, Pixel object) {
  std::vector<Pixel> pixels(kWidth * kHeight);
  std::uniform_real_distribution<double> place(10, 40);
  const double x = place(random), y = place(random);
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u)
      pixels[std::size_t(v * kWidth + u)] =
          (std::hypot(u - x, v - y) < 17) != (random() % 300 == 0) ? object : Pixel(0);
  return pixels;
}

TEST(BackProjection, CarvesAsALoopOverAllVoxels) {
  std::mt19937 random(5);
  std::vector<std::int32_t> labels(kLattice.voxels()), expected(kLattice.voxels());
  std::vector<std::uint8_t> blocks = carving_blocks(kLattice);
  for (int view = 0; view < 12; ++view) {
    const TruncatingCamera camera = some_camera(random, view % 3 == 2 ? 0.4 : 3.5);
    const std::vector<std::uint8_t> mask = some_pixels<std::uint8_t>(random, 255);
    carve_dense(kLattice, camera, {mask, kWidth, kHeight}, labels, blocks);
    for_voxels([&](std::size_t voxel, int i, int j, int k) {
      const int pixel = pixel_of(camera, i, j, k);
      if (pixel < 0 || expected[voxel] == -1) return;
      expected[voxel] = mask[std::size_t(pixel)] == 0 ? -1 : 1;
    });
    ASSERT_EQ(labels, expected) << "view " << view;
  }
}

TEST(BackProjection, AddsAsALoopOverAllVoxels) {
  std::mt19937 random(6);
  std::vector<float> sums(kLattice.voxels()), expected(kLattice.voxels());
  for (int view = 0; view < 8; ++view) {
    const TruncatingCamera camera = some_camera(random, view % 3 == 2 ? 0.4 : 3.5);
    const std::vector<float> image = some_pixels<float>(random, 0.37f);
    add_dense(kLattice, camera, {image, kWidth, kHeight}, sums);
    for_voxels([&](std::size_t voxel, int i, int j, int k) {
      if (const int pixel = pixel_of(camera, i, j, k); pixel >= 0)
        expected[voxel] += image[std::size_t(pixel)];
    });
    ASSERT_EQ(sums, expected) << "view " << view;
  }
}

}  // namespace
}  // namespace photohull::carving

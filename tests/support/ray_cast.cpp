#include "support/ray_cast.h"

#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>

namespace photohull::test {
namespace {

std::uint8_t encode(double linear) {
  return std::uint8_t(std::lround(255 * std::clamp(srgb_from_linear(linear), 0.0, 1.0)));
}

/// A number in [0, 1] for a lattice point, by mixing its bits.
double hash(std::int64_t x, std::int64_t y, std::int64_t z) {
  std::uint64_t h = std::uint64_t(x) * 0x9e3779b97f4a7c15u ^
                    std::uint64_t(y) * 0xc2b2ae3d27d4eb4fu ^ std::uint64_t(z) * 0x165667b19e3779f9u;
  h = (h ^ (h >> 31)) * 0xff51afd7ed558ccdu;
  h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53u;
  return double((h ^ (h >> 33)) >> 11) / double(1ull << 53);
}

}  // namespace

ColourImage ray_cast(const Camera& camera, const Tracer& tracer, int n) {
  const Intrinsics& k = camera.intrinsics;
  const glm::dvec3 eye = camera.center();
  ColourImage image;
  image.width = k.width;
  image.height = k.height;
  for (int y = 0; y < k.height; ++y)
    for (int x = 0; x < k.width; ++x) {
      glm::dvec3 sum(0);
      for (int i = 0; i < n * n; ++i) {
        const glm::dvec2 offset((i % n + 0.5) / n - 0.5, (i / n + 0.5) / n - 0.5);
        sum += tracer(eye, camera.ray(glm::dvec2(x, y) + offset));
      }
      for (int c = 0; c < 3; ++c) image.bytes.push_back(encode(sum[c] / (n * n)));
      image.bytes.push_back(255);
    }
  return image;
}

ColourImage random_image(Rng& rng, int width, int height, int low, int high) {
  std::uniform_int_distribution<int> value(low, high);
  ColourImage image;
  image.width = width;
  image.height = height;
  for (int i = 0; i < width * height * 4; ++i)
    image.bytes.push_back(i % 4 == 3 ? 255 : std::uint8_t(value(rng)));
  return image;
}

ColourImage to_half(const ColourImage& image) {
  ColourImage out;
  out.width = image.width;
  out.height = image.height;
  out.encoding = ColourImage::Encoding::kLinearHalf;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const glm::uint64 packed = glm::packHalf4x16(image.linear(x, y));
      std::uint8_t pixel[8];
      std::memcpy(pixel, &packed, sizeof pixel);
      out.bytes.insert(out.bytes.end(), pixel, pixel + 8);
    }
  return out;
}

double solid_noise(const glm::dvec3& p, double scale) {
  const glm::dvec3 at = p / scale, cell = glm::floor(at), f = at - cell;
  const glm::dvec3 w = f * f * (3.0 - 2.0 * f);
  double sum = 0;
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 d(i & 1, (i >> 1) & 1, i >> 2);
    const double weight = (d.x ? w.x : 1 - w.x) * (d.y ? w.y : 1 - w.y) * (d.z ? w.z : 1 - w.z);
    sum += weight *
           hash(std::int64_t(cell.x) + d.x, std::int64_t(cell.y) + d.y, std::int64_t(cell.z) + d.z);
  }
  return sum;
}

glm::dvec3 noise_colour(const glm::dvec3& p, double scale) {
  glm::dvec3 colour;
  for (int c = 0; c < 3; ++c) {
    const glm::dvec3 shifted = p + 100.0 * scale * (c + 1.0);
    colour[c] = 0.05 + 0.6 * solid_noise(shifted, scale) + 0.3 * solid_noise(shifted, 3.1 * scale);
  }
  return colour;
}

}  // namespace photohull::test

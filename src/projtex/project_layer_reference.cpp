// Projective texture mapping after Segal et al. 1992, filtered after Williams 1983.
#include "projtex/project_layer_reference.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"

namespace photohull::projtex::reference {
namespace {

glm::dvec4 texel(const LinearImage& image, int x, int y) {
  x = std::clamp(x, 0, image.width - 1);
  y = std::clamp(y, 0, image.height - 1);
  return image.pixels[std::size_t(y) * image.width + x];
}

/// `pixel` counts in pixels of level 0, whose centres are integers.
glm::dvec4 bilinear(std::span<const LinearImage> mips, int level, const glm::dvec2& pixel) {
  const LinearImage& image = mips[level];
  const double x = (pixel.x + 0.5) * image.width / mips[0].width - 0.5;
  const double y = (pixel.y + 0.5) * image.height / mips[0].height - 0.5;
  const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
  const glm::dvec4 top = glm::mix(texel(image, x0, y0), texel(image, x0 + 1, y0), x - x0);
  const glm::dvec4 bottom =
      glm::mix(texel(image, x0, y0 + 1), texel(image, x0 + 1, y0 + 1), x - x0);
  return glm::mix(top, bottom, y - y0);
}

glm::dvec4 sample(std::span<const LinearImage> mips, const glm::dvec2& pixel, double lambda,
                  MipFilter filter) {
  const int last = int(mips.size()) - 1;
  if (filter == MipFilter::kNearest)
    return bilinear(mips, std::clamp(int(std::ceil(lambda + 0.5)) - 1, 0, last), pixel);
  const int fine = std::clamp(int(std::floor(lambda)), 0, last), coarse = std::min(fine + 1, last);
  return glm::mix(bilinear(mips, fine, pixel), bilinear(mips, coarse, pixel),
                  std::clamp(lambda - fine, 0.0, 1.0));
}

/// Nothing when the point is not in front of the camera.
std::optional<glm::dvec2> pixel_of(const GridCamera& camera, const glm::dvec3& point) {
  const glm::dvec3 stq = camera.projection * glm::dvec4(point, 1);
  if (!(stq.z > 0)) return std::nullopt;
  return glm::dvec2(stq) / stq.z;
}

bool on_image(const GridCamera& camera, const glm::dvec2& pixel) {
  return pixel.x >= -0.5 && pixel.y >= -0.5 && pixel.x <= camera.width - 0.5 &&
         pixel.y <= camera.height - 0.5;
}

/// How the pixel position moves with the point along `step`: quotient rule on s / q and t / q.
glm::dvec2 derivative(const GridCamera& camera, const glm::dvec3& point, const glm::dvec3& step) {
  const glm::dvec3 at = camera.projection * glm::dvec4(point, 1);
  const glm::dvec3 by = camera.projection * glm::dvec4(step, 0);
  return (glm::dvec2(by) * at.z - glm::dvec2(at) * by.z) / (at.z * at.z);
}

}  // namespace

std::vector<LinearImage> mip_chain(const ColourImage& image, const glm::ivec2& array_size) {
  const auto power_of_two = [](int n) { return n > 0 && (n & (n - 1)) == 0; };
  PHOTOHULL_CHECK(power_of_two(array_size.x) && power_of_two(array_size.y));
  LinearImage level{array_size.x, array_size.y, {}};
  for (int y = 0; y < level.height; ++y)
    for (int x = 0; x < level.width; ++x)
      level.pixels.push_back(
          image.linear(std::min(x, image.width - 1), std::min(y, image.height - 1)));
  std::vector<LinearImage> chain{level};
  while (level.width > 1 || level.height > 1) {
    const LinearImage& fine = chain.back();
    level = {std::max(fine.width / 2, 1), std::max(fine.height / 2, 1), {}};
    // A side of one pixel stays: texel() repeats it.
    for (int y = 0; y < level.height; ++y)
      for (int x = 0; x < level.width; ++x)
        level.pixels.push_back(0.25 *
                               (texel(fine, 2 * x, 2 * y) + texel(fine, 2 * x + 1, 2 * y) +
                                texel(fine, 2 * x, 2 * y + 1) + texel(fine, 2 * x + 1, 2 * y + 1)));
    chain.push_back(level);
  }
  return chain;
}

double mip_level(const GridCamera& camera, const PlaneSquare& square, int supersample) {
  if (!pixel_of(camera, square.centre)) return 0;
  const double longest = std::max(glm::length(derivative(camera, square.centre, square.u)),
                                  glm::length(derivative(camera, square.centre, square.v)));
  return std::log2(std::max(longest / supersample, 1.0));
}

glm::dvec4 project_layer_sample(const GridCamera& camera, std::span<const LinearImage> mips,
                                const PlaneSquare& square, int supersample, double lambda,
                                MipFilter filter) {
  const auto centre = pixel_of(camera, square.centre);
  if (!centre || !on_image(camera, *centre)) return {0, 0, 0, -1};
  glm::dvec4 sum(0);
  for (int b = 0; b < supersample; ++b)
    for (int a = 0; a < supersample; ++a) {
      const double along_u = (a + 0.5) / supersample - 0.5, along_v = (b + 0.5) / supersample - 0.5;
      const glm::dvec3 stq = camera.projection *
                             glm::dvec4(square.centre + along_u * square.u + along_v * square.v, 1);
      sum += sample(mips, glm::dvec2(stq) / stq.z, lambda, filter);
    }
  sum /= double(supersample * supersample);
  return {std::sqrt(sum.r), std::sqrt(sum.g), std::sqrt(sum.b), sum.a};
}

}  // namespace photohull::projtex::reference

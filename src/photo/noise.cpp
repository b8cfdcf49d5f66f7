// Based on Immerkaer, "Fast noise variance estimation", 1996 [Immerkaer1996]: the difference of two
// Laplacians ignores constant, linear and parabolic structure. Applied to flat blocks only, as
// texture would count as noise.
#include "photo/noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace photohull {
namespace {

constexpr int kBlock = 12;          ///< pixels along a block's edge
constexpr int kInner = kBlock - 2;  ///< those with all eight neighbours
constexpr int kBlocksAcross = 24;   ///< at most, along each side
// Square roots; below, quantisation and clipping rule, and unknown pixels are black.
constexpr float kDarkest = 0.08f;
constexpr float kBrightest = 0.97f;  // square root; above, clipping rules
constexpr double kFlattest = 0.2;    ///< share of the blocks that count

struct Block {
  double structure;  ///< how much the block's quadrants differ
  double sigma;
};

/// Square root of luminance (Rec. 709) of a block's pixels.
std::array<float, kBlock * kBlock> load_block(const ColourImage& image, int x0, int y0) {
  static const std::array<float, 256> linear = [] {
    std::array<float, 256> t{};
    for (std::size_t i = 0; i < 256; ++i) t[i] = float(linear_from_srgb(double(i) / 255.0));
    return t;
  }();
  std::array<float, kBlock * kBlock> values{};
  for (int y = 0; y < kBlock; ++y)
    for (int x = 0; x < kBlock; ++x) {
      const std::size_t pixel = std::size_t(y0 + y) * image.width + std::size_t(x0 + x);
      glm::vec3 colour;
      if (image.encoding == ColourImage::Encoding::kSrgb8) {
        const std::uint8_t* p = &image.bytes[pixel * 4];
        colour = {linear[p[0]], linear[p[1]], linear[p[2]]};
      } else {
        colour = glm::vec3(image.linear(x0 + x, y0 + y));
      }
      const float luminance = glm::dot(colour, glm::vec3(0.2126f, 0.7152f, 0.0722f));
      values[std::size_t(y * kBlock + x)] = std::sqrt(std::max(luminance, 0.0f));
    }
  return values;
}

/// Range of the means of a block's four quadrants. Independent of the noise of single pixels, so
/// that choosing blocks by it does not choose those with little noise.
double structure_of(const std::array<float, kBlock * kBlock>& v) {
  std::array<double, 4> sums{};
  for (int y = 0; y < kBlock; ++y)
    for (int x = 0; x < kBlock; ++x)
      sums[std::size_t(2 * (y >= kBlock / 2) + (x >= kBlock / 2))] +=
          v[std::size_t(y * kBlock + x)];
  const auto [low, high] = std::minmax_element(sums.begin(), sums.end());
  return *high - *low;
}

double sigma_of(const std::array<float, kBlock * kBlock>& v) {
  double sum = 0;
  for (int y = 1; y <= kInner; ++y)
    for (int x = 1; x <= kInner; ++x) {
      const float* p = &v[std::size_t(y * kBlock + x)];
      const float cross = p[-1] + p[1] + p[-kBlock] + p[kBlock];
      const float corners = p[-kBlock - 1] + p[-kBlock + 1] + p[kBlock - 1] + p[kBlock + 1];
      sum += std::abs(corners - 2 * cross + 4 * p[0]);
    }
  // The mask's coefficients have the root of squares 6; E|x| = sigma sqrt(2 / pi).
  return std::sqrt(M_PI / 2) / 6 * sum / (kInner * kInner);
}

}  // namespace

double estimate_image_noise(const ColourImage& image) {
  std::vector<Block> blocks;
  const int nx = std::min(image.width / kBlock, kBlocksAcross);
  const int ny = std::min(image.height / kBlock, kBlocksAcross);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int x0 = int(std::int64_t(image.width - kBlock) * i / std::max(nx - 1, 1));
      const int y0 = int(std::int64_t(image.height - kBlock) * j / std::max(ny - 1, 1));
      const auto values = load_block(image, x0, y0);
      const auto [low, high] = std::minmax_element(values.begin(), values.end());
      // A block without any difference was painted or clipped; it tells nothing.
      if (*low < kDarkest || *high > kBrightest || *low == *high) continue;
      blocks.push_back({structure_of(values), sigma_of(values)});
    }
  if (blocks.empty()) return 0;
  const std::size_t flat = std::max<std::size_t>(1, std::size_t(kFlattest * double(blocks.size())));
  std::nth_element(blocks.begin(), blocks.begin() + std::ptrdiff_t(flat - 1), blocks.end(),
                   [](const Block& a, const Block& b) { return a.structure < b.structure; });
  const auto middle = blocks.begin() + std::ptrdiff_t(flat / 2);
  std::nth_element(blocks.begin(), middle, blocks.begin() + std::ptrdiff_t(flat),
                   [](const Block& a, const Block& b) { return a.sigma < b.sigma; });
  return middle->sigma;
}

}  // namespace photohull

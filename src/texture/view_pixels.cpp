#include "texture/view_pixels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "texture/surface.h"

namespace photohull::texture {
namespace {

constexpr std::uint8_t kOpaque = 255;

const std::array<float, 256>& linear_of_code() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values;
    for (int i = 0; i < 256; ++i) values[i] = float(linear_from_srgb(i / 255.0));
    return values;
  }();
  return table;
}

/// Sums of columns [x0, x1) of a row with the shares of the pixels at its ends.
template <typename F>
void weigh(double low, double high, int size, const F& f) {
  const int first = std::clamp(int(std::floor(low)), 0, size - 1);
  const int last = std::clamp(int(std::ceil(high)) - 1, first, size - 1);
  for (int i = first; i <= last; ++i)
    f(i, std::max(std::min(high, i + 1.0) - std::max(low, double(i)), 1e-6));
}

/// Mean of the pixels' areas, in half floats.
ColourImage reduce(const ColourImage& image, int width, int height) {
  ColourImage out{width, height, ColourImage::Encoding::kLinearHalf, image.has_alpha, {}};
  out.bytes.resize(std::size_t(width) * height * 8);
  const double step_x = double(image.width) / width, step_y = double(image.height) / height;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      glm::dvec4 sum(0);
      double total = 0;
      weigh(y * step_y, (y + 1) * step_y, image.height, [&](int row, double share) {
        weigh(x * step_x, (x + 1) * step_x, image.width, [&](int column, double part) {
          sum += share * part * glm::dvec4(image.linear(column, row));
          total += share * part;
        });
      });
      const std::uint64_t packed = glm::packHalf4x16(glm::vec4(sum / total));
      std::memcpy(&out.bytes[(std::size_t(y) * width + x) * 8], &packed, 8);
    }
  return out;
}

/// Catmull-Rom's weights of the pixels at -1, 0, 1, 2 for the position t in [0, 1].
std::array<float, 4> cubic(float t) {
  const float t2 = t * t, t3 = t2 * t;
  return {0.5f * (-t3 + 2 * t2 - t), 0.5f * (3 * t3 - 5 * t2 + 2), 0.5f * (-3 * t3 + 4 * t2 + t),
          0.5f * (t3 - t2)};
}

}  // namespace

Camera scaled_camera(const PreparedView& view, double scale) {
  Camera camera = view.camera;
  if (scale >= 1) return camera;
  Intrinsics& k = camera.intrinsics;
  k.width = std::max(1, int(std::lround(scale * view.image.width)));
  k.height = std::max(1, int(std::lround(scale * view.image.height)));
  const glm::dvec2 by(double(k.width) / view.image.width, double(k.height) / view.image.height);
  k.fx *= by.x;
  k.skew *= by.x;
  k.fy *= by.y;
  k.cx = (k.cx + 0.5) * by.x - 0.5;
  k.cy = (k.cy + 0.5) * by.y - 0.5;
  return camera;
}

ViewPixels::ViewPixels(const PreparedView& view, double scale)
    : view_(view), camera_(scaled_camera(view, scale)) {
  if (scale >= 1) return;
  const Intrinsics& k = camera_.intrinsics;
  reduced_ = reduce(view.image, k.width, k.height);
  scale_ = {double(k.width) / view.image.width, double(k.height) / view.image.height};
}

glm::vec3 ViewPixels::linear(int x, int y) const {
  const ColourImage& pixels = image();
  if (pixels.encoding != ColourImage::Encoding::kSrgb8) return glm::vec3(pixels.linear(x, y));
  const std::uint8_t* p = &pixels.bytes[4 * (std::size_t(y) * pixels.width + x)];
  const std::array<float, 256>& table = linear_of_code();
  return {table[p[0]], table[p[1]], table[p[2]]};
}

glm::vec3 ViewPixels::root(int x, int y) const { return root_of(linear(x, y)); }

glm::vec3 ViewPixels::root_between(const glm::dvec2& pixel) const {
  const double px = std::clamp(pixel.x, 0.0, double(width() - 1));
  const double py = std::clamp(pixel.y, 0.0, double(height() - 1));
  const int x0 = int(px), y0 = int(py);
  const std::array<float, 4> wx = cubic(float(px - x0)), wy = cubic(float(py - y0));
  glm::vec3 sum(0);
  for (int j = -1; j <= 2; ++j)
    for (int i = -1; i <= 2; ++i)
      sum += wx[std::size_t(i + 1)] * wy[std::size_t(j + 1)] *
             linear(std::clamp(x0 + i, 0, width() - 1), std::clamp(y0 + j, 0, height() - 1));
  return root_of(sum);
}

bool ViewPixels::known(int x, int y) const {
  const ColourImage& pixels = image();
  if (!pixels.has_alpha) return true;
  if (pixels.encoding != ColourImage::Encoding::kSrgb8) return pixels.linear(x, y).a > 0.999f;
  return pixels.bytes[4 * (std::size_t(y) * pixels.width + x) + 3] == kOpaque;
}

std::optional<float> ViewPixels::inside(int x, int y) const {
  const SilhouetteDistance& distance = view_.silhouette.distance;
  if (distance.pixels.empty()) return std::nullopt;
  const int column = std::clamp(int((x + 0.5) / scale_.x), 0, distance.width - 1);
  const int row = std::clamp(int((y + 0.5) / scale_.y), 0, distance.height - 1);
  return -distance.pixels[std::size_t(row) * distance.width + column] *
         float(std::min(scale_.x, scale_.y));
}

}  // namespace photohull::texture

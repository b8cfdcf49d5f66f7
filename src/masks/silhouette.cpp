// Signed distance to the 50 % contour of an anti-aliased mask.
//
// Contour: marching squares between pixel centres. A crossing between two neighbours is placed by
// the area that the object covers in four pixels in a row, after Trujillo-Pino et al., "Accurate
// subpixel edge location based on partial area effect", 2013 [TrujilloPino2013].
// Distance: every pixel carries the nearest contour point found so far and offers it to its
// neighbours in two sweeps, after Danielsson, "Euclidean distance mapping", 1980 [Danielsson1980].
#include "masks/silhouette.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/error.h"

namespace photohull {
namespace {

/// Segments are measured exactly from pixels this close to their cell. Farther off the sweeps err
/// by up to about 0.5 / distance pixels, since they lose a point whose pixels are under one pixel
/// wide.
constexpr int kReach = 2;
constexpr int kSaturated = 4;       ///< coverage this close to 0 or 255 counts as none or all
constexpr float kUnreached = 1e9f;  ///< coordinate of points that are not known yet

struct Point {
  float x, y;
};

float squared(float dx, float dy) { return dx * dx + dy * dy; }

bool is_foreground(std::uint8_t coverage) { return coverage >= 128; }

/// Nearest contour point of every pixel of a mask. Rows are padded by an
/// unreached pixel at either end.
class NearestPoints {
 public:
  NearestPoints(int width, int height)
      : width_(width),
        height_(height),
        x_(std::size_t(width + 2) * height, kUnreached),
        y_(x_.size(), kUnreached) {}

  void offer_segment(int x, int y, Point a, Point b);
  void sweep();
  /// Distances of a row, with the sign of its coverage.
  void signed_distances(int y, const std::uint8_t* coverage, float* out) const;

 private:
  std::size_t row(int y) const { return std::size_t(y) * (width_ + 2) + 1; }
  void offer_row(int y, int from_y);
  void sweep_row(int y, int step);

  int width_, height_;
  std::vector<float> x_, y_;
};

/// Offers a segment of the contour that lies in the cell (x, y)..(x+1, y+1) to the pixels around.
void NearestPoints::offer_segment(int x, int y, Point a, Point b) {
  const float dx = b.x - a.x, dy = b.y - a.y;
  const float inverse = 1.0f / std::max(dx * dx + dy * dy, 1e-12f);
  for (int py = std::max(y - kReach, 0); py <= std::min(y + 1 + kReach, height_ - 1); ++py)
    for (int px = std::max(x - kReach, 0); px <= std::min(x + 1 + kReach, width_ - 1); ++px) {
      const float s = std::clamp(((px - a.x) * dx + (py - a.y) * dy) * inverse, 0.0f, 1.0f);
      const Point p{a.x + s * dx, a.y + s * dy};
      float& best_x = x_[row(py) + px];
      float& best_y = y_[row(py) + px];
      if (squared(px - p.x, py - p.y) < squared(px - best_x, py - best_y)) {
        best_x = p.x;
        best_y = p.y;
      }
    }
}

/// Takes over points from the three neighbours in an adjacent row; free of dependencies along x.
void NearestPoints::offer_row(int y, int from_y) {
  float* __restrict to_x = &x_[row(y)];
  float* __restrict to_y = &y_[row(y)];
  const float* __restrict from_x = &x_[row(from_y)];
  const float* __restrict from_points_y = &y_[row(from_y)];
  for (int x = 0; x < width_; ++x) {
    Point best{to_x[x], to_y[x]};
    float nearest = squared(x - best.x, y - best.y);
    for (int shift = -1; shift <= 1; ++shift) {
      const Point p{from_x[x + shift], from_points_y[x + shift]};
      const float distance = squared(x - p.x, y - p.y);
      const bool nearer = distance < nearest;
      best = {nearer ? p.x : best.x, nearer ? p.y : best.y};
      nearest = nearer ? distance : nearest;
    }
    to_x[x] = best.x;
    to_y[x] = best.y;
  }
}

/// Hands points on along a row. The branch is taken in long runs, so that it costs less than a
/// selection, which would make every pixel wait for the one before.
void NearestPoints::sweep_row(int y, int step) {
  const int begin = step > 0 ? 0 : width_ - 1, end = step > 0 ? width_ : -1;
  float* points_x = &x_[row(y)];
  float* points_y = &y_[row(y)];
  Point best{points_x[begin], points_y[begin]};
  for (int x = begin + step; x != end; x += step) {
    const Point own{points_x[x], points_y[x]};
    if (squared(x - best.x, y - best.y) < squared(x - own.x, y - own.y)) {
      points_x[x] = best.x;
      points_y[x] = best.y;
    } else {
      best = own;
    }
  }
}

void NearestPoints::sweep() {
  for (int y = 0; y < height_; ++y) {
    if (y > 0) offer_row(y, y - 1);
    sweep_row(y, 1);
    sweep_row(y, -1);
  }
  for (int y = height_ - 2; y >= 0; --y) {
    offer_row(y, y + 1);
    sweep_row(y, 1);
    sweep_row(y, -1);
  }
}

void NearestPoints::signed_distances(int y, const std::uint8_t* coverage, float* out) const {
  const float* points_x = &x_[row(y)];
  const float* points_y = &y_[row(y)];
  for (int x = 0; x < width_; ++x) {
    const float d = std::sqrt(squared(x - points_x[x], y - points_y[x]));
    out[x] = is_foreground(coverage[x]) ? -d : d;
  }
}

/// Where the contour crosses between neighbours p[0] and p[stride], in [0, 1]. `outer`: p[-stride]
/// and p[2 * stride] exist.
float crossing(const std::uint8_t* p, std::ptrdiff_t stride, bool outer) {
  const int a = p[0], b = p[stride];
  if (outer) {
    const int before = p[-stride], after = p[2 * stride];
    const bool rises = before <= kSaturated && after >= 255 - kSaturated;
    const bool falls = after <= kSaturated && before >= 255 - kSaturated;
    // A straight edge that enters and leaves within the four pixels: they are covered up to it.
    if (rises) return 2.5f - float(before + a + b + after) / 255.0f;
    if (falls) return float(before + a + b + after) / 255.0f - 1.5f;
  }
  return (127.5f - a) / float(b - a);
}

/// Offers the contour segments of one cell of four pixel centres; (x, y) is its top-left pixel.
void trace_cell(const Mask& mask, int x, int y, NearestPoints& nearest) {
  const std::ptrdiff_t stride = mask.width;
  const std::uint8_t* p = mask.coverage.data() + y * stride + x;
  const bool in00 = is_foreground(p[0]), in10 = is_foreground(p[1]);
  const bool in01 = is_foreground(p[stride]), in11 = is_foreground(p[stride + 1]);
  const bool outer_x = x > 0 && x + 2 < mask.width, outer_y = y > 0 && y + 2 < mask.height;
  Point points[4];  // crossings of the top, right, bottom and left edge, in this order
  int n = 0;
  if (in00 != in10) points[n++] = {x + crossing(p, 1, outer_x), float(y)};
  if (in10 != in11) points[n++] = {float(x + 1), y + crossing(p + 1, stride, outer_y)};
  if (in01 != in11) points[n++] = {x + crossing(p + stride, 1, outer_x), float(y + 1)};
  if (in00 != in01) points[n++] = {float(x), y + crossing(p, stride, outer_y)};
  if (n == 2) nearest.offer_segment(x, y, points[0], points[1]);
  if (n == 4) {
    // A saddle: the mean tells whether the foreground corners are joined.
    const bool joined = is_foreground((p[0] + p[1] + p[stride] + p[stride + 1]) / 4);
    const int first = joined == in00 ? 1 : 3;  // top joins right or left
    nearest.offer_segment(x, y, points[0], points[first]);
    nearest.offer_segment(x, y, points[2], points[4 - first]);
  }
}

/// Are the pixels p[0..8] and those of the row below all foreground or all background?
bool is_uniform(const std::uint8_t* p, int stride) {
  constexpr std::uint64_t kTopBits = 0x8080808080808080u;
  std::uint64_t eight[4];
  std::memcpy(&eight[0], p, 8);
  std::memcpy(&eight[1], p + 1, 8);
  std::memcpy(&eight[2], p + stride, 8);
  std::memcpy(&eight[3], p + stride + 1, 8);
  return ((eight[0] | eight[1] | eight[2] | eight[3]) & kTopBits) == 0 ||
         (eight[0] & eight[1] & eight[2] & eight[3] & kTopBits) == kTopBits;
}

/// Calls visit(x, y) for each cell of four pixel centres that the contour crosses.
template <typename Visit>
void for_each_contour_cell(const Mask& mask, const Visit& visit) {
  for (int y = 0; y + 1 < mask.height; ++y) {
    const std::uint8_t* row = mask.coverage.data() + std::size_t(y) * mask.width;
    const std::uint8_t* next = row + mask.width;
    for (int x = 0; x + 1 < mask.width; ++x) {
      if (x + 9 <= mask.width && is_uniform(row + x, mask.width)) {
        x += 7;
        continue;
      }
      const int inside = is_foreground(row[x]) + is_foreground(row[x + 1]) +
                         is_foreground(next[x]) + is_foreground(next[x + 1]);
      if (inside != 0 && inside != 4) visit(x, y);
    }
  }
}

}  // namespace

SilhouetteDistance silhouette_distance(const Mask& mask) {
  PHOTOHULL_CHECK(!mask.empty());
  PHOTOHULL_CHECK_OP(mask.coverage.size(), ==, std::size_t(mask.width) * mask.height);
  SilhouetteDistance result{mask.width, mask.height, {}};
  NearestPoints nearest(mask.width, mask.height);
  bool has_contour = false;
  for_each_contour_cell(mask, [&](int x, int y) {
    has_contour = true;
    trace_cell(mask, x, y, nearest);
  });
  if (!has_contour) {
    const float none = SilhouetteDistance::kNoContour;
    result.pixels.assign(mask.coverage.size(), is_foreground(mask.coverage[0]) ? -none : none);
    return result;
  }
  nearest.sweep();
  result.pixels.resize(mask.coverage.size());
  for (int y = 0; y < mask.height; ++y) {
    const std::size_t row = std::size_t(y) * mask.width;
    nearest.signed_distances(y, &mask.coverage[row], &result.pixels[row]);
  }
  return result;
}

void weigh_by_certainty(const Mask& mask, SilhouetteDistance& distance) {
  PHOTOHULL_CHECK_OP(mask.coverage.size(), ==, distance.pixels.size());
  for (std::size_t i = 0; i < distance.pixels.size(); ++i)
    if (distance.pixels[i] > 0)
      distance.pixels[i] *= std::max(1 - float(mask.coverage[i]) / 127.5f, 0.0f);
}

double interpolated(const SilhouetteDistance& distance, const glm::dvec2& pixel) {
  const int left = int(std::floor(pixel.x)), top = int(std::floor(pixel.y));
  const auto at = [&](int x, int y) {
    return double(distance.pixels[std::size_t(std::clamp(y, 0, distance.height - 1)) *
                                      std::size_t(distance.width) +
                                  std::size_t(std::clamp(x, 0, distance.width - 1))]);
  };
  const double u = pixel.x - left, v = pixel.y - top;
  return (1 - v) * ((1 - u) * at(left, top) + u * at(left + 1, top)) +
         v * ((1 - u) * at(left, top + 1) + u * at(left + 1, top + 1));
}

}  // namespace photohull

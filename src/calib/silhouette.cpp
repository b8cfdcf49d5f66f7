// Signed distance to the 50 % contour of an anti-aliased mask.
//
// Contour: marching squares between pixel centres. A crossing between two neighbours is placed by
// the area that the object covers in four pixels in a row, after Trujillo-Pino et al., "Accurate
// subpixel edge location based on partial area effect", 2013 [TrujilloPino2013].
// Distance: every pixel carries the nearest contour point found so far and offers it to its
// neighbours in two sweeps, after Danielsson, "Euclidean distance mapping", 1980 [Danielsson1980].
#include "calib/silhouette.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace photohull {
namespace {

constexpr int kMargin = 16;    ///< pixels around the contour's box where distances are swept
constexpr int kSaturated = 4;  ///< coverage this close to 0 or 255 counts as none or all
constexpr float kUnreached = 1e30f;

struct Point {
  float x, y;
};

/// Pixels [x0, x1) x [y0, y1) of the mask.
struct Window {
  int x0, y0, x1, y1;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
};

bool is_foreground(std::uint8_t coverage) { return coverage >= 128; }

/// Nearest contour point of every pixel of a window, in window coordinates.
class NearestPoints {
 public:
  NearestPoints(int width, int height)
      : width_(width), height_(height), x_(count()), y_(count()), squared_(count(), kUnreached) {}

  void offer_segment(int x, int y, Point a, Point b);
  void sweep();
  float distance(int x, int y) const { return std::sqrt(squared_[index(x, y)]); }

 private:
  std::size_t count() const { return std::size_t(width_) * height_; }
  std::size_t index(int x, int y) const { return std::size_t(y) * width_ + x; }
  void offer_row(int y, int from_y);
  void sweep_row(int y, int step);

  int width_, height_;
  std::vector<float> x_, y_, squared_;
};

/// Offers a segment of the contour that lies in the cell (x, y)..(x+1, y+1) to the pixels around.
void NearestPoints::offer_segment(int x, int y, Point a, Point b) {
  const float dx = b.x - a.x, dy = b.y - a.y;
  const float inverse = 1.0f / std::max(dx * dx + dy * dy, 1e-12f);
  for (int py = std::max(y - 1, 0); py <= std::min(y + 2, height_ - 1); ++py)
    for (int px = std::max(x - 1, 0); px <= std::min(x + 2, width_ - 1); ++px) {
      const float s = std::clamp(((px - a.x) * dx + (py - a.y) * dy) * inverse, 0.0f, 1.0f);
      const float fx = a.x + s * dx, fy = a.y + s * dy;
      const float squared = (px - fx) * (px - fx) + (py - fy) * (py - fy);
      const std::size_t i = index(px, py);
      if (squared < squared_[i]) {
        x_[i] = fx;
        y_[i] = fy;
        squared_[i] = squared;
      }
    }
}

/// Takes over points from the three neighbours in an adjacent row; free of dependencies along x.
void NearestPoints::offer_row(int y, int from_y) {
  const std::size_t to = index(0, y), from = index(0, from_y);
  for (int shift = -1; shift <= 1; ++shift) {
    const int begin = std::max(0, -shift), end = std::min(width_, width_ - shift);
    float* __restrict tx = &x_[to];
    float* __restrict ty = &y_[to];
    float* __restrict td = &squared_[to];
    const float* __restrict sx = &x_[from] + shift;
    const float* __restrict sy = &y_[from] + shift;
    const float* __restrict sd = &squared_[from] + shift;
    for (int x = begin; x < end; ++x) {
      const float dx = float(x) - sx[x], dy = float(y) - sy[x];
      const float squared = sd[x] < kUnreached ? dx * dx + dy * dy : kUnreached;
      const bool nearer = squared < td[x];
      tx[x] = nearer ? sx[x] : tx[x];
      ty[x] = nearer ? sy[x] : ty[x];
      td[x] = nearer ? squared : td[x];
    }
  }
}

void NearestPoints::sweep_row(int y, int step) {
  const int begin = step > 0 ? 0 : width_ - 1, end = step > 0 ? width_ : -1;
  float* row_x = &x_[index(0, y)];
  float* row_y = &y_[index(0, y)];
  float* row_d = &squared_[index(0, y)];
  Point best{row_x[begin], row_y[begin]};
  bool reached = row_d[begin] < kUnreached;
  for (int x = begin + step; x != end; x += step) {
    const float dx = float(x) - best.x, dy = float(y) - best.y;
    const float squared = dx * dx + dy * dy;
    if (reached && squared < row_d[x]) {
      row_x[x] = best.x;
      row_y[x] = best.y;
      row_d[x] = squared;
    } else if (row_d[x] < kUnreached) {
      best = {row_x[x], row_y[x]};
      reached = true;
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
void trace_cell(const Mask& mask, int x, int y, const Window& window, NearestPoints& nearest) {
  const std::ptrdiff_t stride = mask.width;
  const std::uint8_t* p = mask.coverage.data() + y * stride + x;
  const bool in00 = is_foreground(p[0]), in10 = is_foreground(p[1]);
  const bool in01 = is_foreground(p[stride]), in11 = is_foreground(p[stride + 1]);
  const bool outer_x = x > 0 && x + 2 < mask.width, outer_y = y > 0 && y + 2 < mask.height;
  const int wx = x - window.x0, wy = y - window.y0;
  Point points[4];  // crossings of the top, right, bottom and left edge, in this order
  int n = 0;
  if (in00 != in10) points[n++] = {wx + crossing(p, 1, outer_x), float(wy)};
  if (in10 != in11) points[n++] = {float(wx + 1), wy + crossing(p + 1, stride, outer_y)};
  if (in01 != in11) points[n++] = {wx + crossing(p + stride, 1, outer_x), float(wy + 1)};
  if (in00 != in01) points[n++] = {float(wx), wy + crossing(p, stride, outer_y)};
  if (n == 2) nearest.offer_segment(wx, wy, points[0], points[1]);
  if (n == 4) {
    // A saddle: the mean tells whether the foreground corners are joined.
    const bool joined = is_foreground((p[0] + p[1] + p[stride] + p[stride + 1]) / 4);
    const int first = joined == in00 ? 1 : 3;  // top joins right or left
    nearest.offer_segment(wx, wy, points[0], points[first]);
    nearest.offer_segment(wx, wy, points[2], points[4 - first]);
  }
}

/// Calls visit(x, y) for each cell of four pixel centres that the contour crosses.
template <typename Visit>
void for_each_contour_cell(const Mask& mask, const Visit& visit) {
  for (int y = 0; y + 1 < mask.height; ++y) {
    const std::uint8_t* row = mask.coverage.data() + std::size_t(y) * mask.width;
    const std::uint8_t* next = row + mask.width;
    int before = is_foreground(row[0]) + is_foreground(next[0]);
    for (int x = 0; x + 1 < mask.width; ++x) {
      const int after = is_foreground(row[x + 1]) + is_foreground(next[x + 1]);
      if (before + after != 0 && before + after != 4) visit(x, y);
      before = after;
    }
  }
}

/// Beyond the window, q being the window's pixel nearest to p, every contour point c satisfies
/// |p - c|^2 >= |p - q|^2 + |q - c|^2, because the window is convex and holds the contour.
void extend_beyond(const Window& window, SilhouetteDistance& result) {
  for (int y = 0; y < result.height; ++y) {
    const int qy = std::clamp(y, window.y0, window.y1 - 1);
    const float dy = float(y - qy);
    float* row = &result.pixels[std::size_t(y) * result.width];
    const float* inner = &result.pixels[std::size_t(qy) * result.width];
    const auto bound = [&](int x, int qx) {
      const float dx = float(x - qx), d = inner[qx];
      row[x] = std::copysign(std::sqrt(dx * dx + dy * dy + d * d), d);
    };
    for (int x = 0; x < window.x0; ++x) bound(x, window.x0);
    if (qy != y)
      for (int x = window.x0; x < window.x1; ++x) bound(x, x);
    for (int x = window.x1; x < result.width; ++x) bound(x, window.x1 - 1);
  }
}

}  // namespace

SilhouetteDistance silhouette_distance(const Mask& mask) {
  PHOTOHULL_CHECK(!mask.empty());
  PHOTOHULL_CHECK_OP(mask.coverage.size(), ==, std::size_t(mask.width) * mask.height);
  SilhouetteDistance result{mask.width, mask.height, {}};
  std::vector<std::pair<int, int>> cells;
  Window window{mask.width, mask.height, 0, 0};
  for_each_contour_cell(mask, [&](int x, int y) {
    cells.emplace_back(x, y);
    window = {std::min(window.x0, x), std::min(window.y0, y), std::max(window.x1, x + 2),
              std::max(window.y1, y + 2)};
  });
  if (cells.empty()) {
    const bool inside = is_foreground(mask.coverage[0]);
    result.pixels.assign(mask.coverage.size(),
                         inside ? -SilhouetteDistance::kNoContour : SilhouetteDistance::kNoContour);
    return result;
  }
  window = {std::max(window.x0 - kMargin, 0), std::max(window.y0 - kMargin, 0),
            std::min(window.x1 + kMargin, mask.width), std::min(window.y1 + kMargin, mask.height)};
  NearestPoints nearest(window.width(), window.height());
  for (const auto& [x, y] : cells) trace_cell(mask, x, y, window, nearest);
  nearest.sweep();

  result.pixels.resize(mask.coverage.size());
  for (int y = window.y0; y < window.y1; ++y)
    for (int x = window.x0; x < window.x1; ++x) {
      const std::size_t i = std::size_t(y) * mask.width + x;
      const float d = nearest.distance(x - window.x0, y - window.y0);
      result.pixels[i] = is_foreground(mask.coverage[i]) ? -d : d;
    }
  extend_beyond(window, result);
  return result;
}

}  // namespace photohull

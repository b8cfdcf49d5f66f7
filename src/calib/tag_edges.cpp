#include "calib/tag_edges.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/median.h"

namespace photohull {
namespace {

constexpr double kStep = 0.25;                        // pixels, along a profile
constexpr double kLeastReach = 1.25, kMostReach = 6;  // pixels to either side
constexpr double kReachInCells = 0.75;
constexpr double kLeastContrast = 0.02;  // of linear light
constexpr double kLeastPeers = 0.35;     // of the greatest contrast of the tag's edges
constexpr double kMostUneven = 0.3;      // of the contrast, between an edge's places
constexpr double kSearchPixels = 2.5, kSearchInCells = 0.9;  // to either side at first
constexpr double kCoarseSpread = 0.9, kMostSpread = 0.45;    // pixels, of an edge's points
constexpr double kLeastCell = 1, kLeastSine = 0.05;          // pixels; of the angle of two edges
constexpr std::size_t kFewestProfiles = 5;
constexpr int kRounds = 4;

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

bool inside(const cv::Mat& image, const glm::dvec2& p) {
  return p.x >= 0 && p.y >= 0 && p.x <= image.cols - 1 && p.y <= image.rows - 1;
}

double sample(const cv::Mat& image, const glm::dvec2& p) {
  const int x = std::min(int(p.x), image.cols - 2), y = std::min(int(p.y), image.rows - 2);
  const double u = p.x - x, v = p.y - y;
  const float *a = image.ptr<float>(y) + x, *b = image.ptr<float>(y + 1) + x;
  return (1 - v) * ((1 - u) * double(a[0]) + u * double(a[1])) +
         v * ((1 - u) * double(b[0]) + u * double(b[1]));
}

/// A line by a point and a unit direction.
struct Line {
  glm::dvec2 point, direction;
};

struct EdgePoints {
  std::vector<glm::dvec2> places;
  std::vector<double> darks, contrasts, widths;
  std::size_t asked = 0;
};

/// Without the places where something else than the edge's paper or ink lies to either side.
void drop_covered(EdgePoints& edge) {
  if (edge.places.empty()) return;
  const double dark = median(edge.darks), contrast = median(edge.contrasts);
  EdgePoints kept;
  kept.asked = edge.asked;
  for (std::size_t i = 0; i < edge.places.size(); ++i) {
    if (std::abs(edge.darks[i] - dark) > kMostUneven * contrast) continue;
    if (std::abs(edge.contrasts[i] - contrast) > kMostUneven * contrast) continue;
    kept.places.push_back(edge.places[i]);
    kept.darks.push_back(edge.darks[i]);
    kept.contrasts.push_back(edge.contrasts[i]);
    kept.widths.push_back(edge.widths[i]);
  }
  edge = std::move(kept);
}

/// Brightness across an edge, from `reach` inside the tag to as far outside.
std::vector<double> profile(const cv::Mat& image, const glm::dvec2& at, const glm::dvec2& outward,
                            double reach) {
  const int half = int(std::round(reach / kStep));
  std::vector<double> light;
  for (int k = -half; k <= half; ++k) light.push_back(sample(image, at + k * kStep * outward));
  return light;
}

/// Calls visit(place, outward) along an edge from a to b, with the tag's inside at the right as the
/// picture shows it, where a profile of that reach is in the picture. Returns how many were tried.
template <typename Visit>
std::size_t for_each_place(const cv::Mat& image, const glm::dvec2& a, const glm::dvec2& b,
                           double reach, const Visit& visit) {
  const double length = glm::length(b - a);
  const glm::dvec2 along = (b - a) / length, outward(along.y, -along.x);
  const int count = std::clamp(int(length), 8, 96);
  for (int i = 0; i < count; ++i) {
    const glm::dvec2 at =
        glm::mix(a, b, kTagEdgeMargin + (1 - 2 * kTagEdgeMargin) * (i + 0.5) / count);
    if (inside(image, at - reach * outward) && inside(image, at + reach * outward))
      visit(at, outward);
  }
  return std::size_t(count);
}

/// Where brightness rises most, to about half a pixel, wherever in reach the edge is.
EdgePoints find_rises(const cv::Mat& image, const glm::dvec2& a, const glm::dvec2& b,
                      double reach) {
  EdgePoints found;
  found.asked =
      for_each_place(image, a, b, reach, [&](const glm::dvec2& at, const glm::dvec2& out) {
        const std::vector<double> light = profile(image, at, out, reach);
        constexpr std::size_t kSpan = std::size_t(1 / kStep);  // a pixel
        double most = kLeastContrast / 2, offset = 0;
        for (std::size_t k = 0; k + kSpan < light.size(); ++k)
          if (light[k + kSpan] - light[k] > most) {
            most = light[k + kSpan] - light[k];
            offset = kStep * (double(k) + 0.5 * kSpan - 0.5 * double(light.size() - 1));
          }
        if (most > kLeastContrast / 2) found.places.push_back(at + offset * out);
      });
  return found;
}

/// To fractions of a pixel, where the edge is known to lie well within reach.
EdgePoints find_points(const cv::Mat& image, const glm::dvec2& a, const glm::dvec2& b,
                       double reach) {
  EdgePoints found;
  found.asked =
      for_each_place(image, a, b, reach, [&](const glm::dvec2& at, const glm::dvec2& out) {
        const std::vector<double> light = profile(image, at, out, reach);
        const std::size_t ends = std::max<std::size_t>(1, light.size() / 8);
        double dark = 0, bright = 0, area = 0;
        for (std::size_t k = 0; k < ends; ++k)
          dark += light[k] / double(ends), bright += light[light.size() - 1 - k] / double(ends);
        const double contrast = bright - dark;
        if (!(contrast > kLeastContrast)) return;
        // The area under the profile is that of a step, however blurred to both sides alike.
        std::size_t rising = 0;
        for (const double value : light) {
          const double share = (value - dark) / contrast;
          area += share;
          rising += share > 0.2 && share < 0.8;
        }
        const double offset = kStep * (double(light.size()) / 2 - area);
        if (std::abs(offset) > reach) return;
        found.places.push_back(at + offset * out);
        found.darks.push_back(dark);
        found.contrasts.push_back(contrast);
        found.widths.push_back(kStep * double(rising));
      });
  drop_covered(found);
  return found;
}

Line fit(const std::vector<glm::dvec2>& points, const std::vector<double>& weights) {
  double sum = 0;
  glm::dvec2 middle(0);
  for (std::size_t i = 0; i < points.size(); ++i)
    sum += weights[i], middle += weights[i] * points[i];
  middle /= sum;
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec2 d = points[i] - middle;
    xx += weights[i] * d.x * d.x, xy += weights[i] * d.x * d.y, yy += weights[i] * d.y * d.y;
  }
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  return {middle, {std::cos(angle), std::sin(angle)}};
}

/// Points of more than a tenth of the weight in that third of the line that has the fewest. Corners
/// are where lines go on to, so that what covers an edge's end would move them.
std::size_t fewest_in_thirds(const std::vector<glm::dvec2>& points,
                             const std::vector<double>& weights, const Line& line) {
  std::vector<double> along;
  for (const glm::dvec2& p : points) along.push_back(glm::dot(p - line.point, line.direction));
  const auto [low, high] = std::minmax_element(along.begin(), along.end());
  std::array<std::size_t, 3> count{};
  for (std::size_t i = 0; i < along.size(); ++i)
    if (weights[i] > 0.1)
      ++count[along[i] < *low + (*high - *low) / 3    ? 0
              : along[i] > *high - (*high - *low) / 3 ? 2
                                                      : 1];
  return *std::min_element(count.begin(), count.end());
}

/// By Tukey's weights about the median distance; nothing where the points are on no line, to a
/// deviation of `most` pixels.
std::optional<Line> fit_robustly(const EdgePoints& edge, double most) {
  constexpr double kTukey = 4.7, kPerMedian = 1.4826, kLeastSpread = 0.03;
  if (edge.places.size() < std::max(kFewestProfiles, edge.asked * 6 / 10)) return std::nullopt;
  std::vector<double> weights(edge.places.size(), 1.0), far(edge.places.size());
  Line line = fit(edge.places, weights);
  double spread = 0;
  for (int round = 0; round < 5; ++round) {
    for (std::size_t i = 0; i < far.size(); ++i)
      far[i] = std::abs(cross(edge.places[i] - line.point, line.direction));
    spread = std::max(kLeastSpread, kPerMedian * median(far));
    for (std::size_t i = 0; i < far.size(); ++i) {
      const double r = far[i] / (kTukey * spread);
      weights[i] = r < 1 ? (1 - r * r) * (1 - r * r) : 0;
    }
    line = fit(edge.places, weights);
  }
  // Half of what was asked for, in each third of the edge.
  if (spread > most || edge.places.size() < kFewestProfiles ||
      fewest_in_thirds(edge.places, weights, line) < edge.asked / 6)
    return std::nullopt;
  return line;
}

glm::dvec2 meet(const Line& a, const Line& b) {
  const double s = cross(b.point - a.point, b.direction) / cross(a.direction, b.direction);
  return a.point + s * a.direction;
}

/// Pixels to a cell, across each edge.
std::array<double, 4> cell_sizes(const std::array<glm::dvec2, 4>& c, int cells) {
  const double area = 0.5 * std::abs(cross(c[2] - c[0], c[3] - c[1]));
  std::array<double, 4> sizes;
  for (std::size_t i = 0; i < 4; ++i) sizes[i] = area / glm::length(c[(i + 1) % 4] - c[i]) / cells;
  return sizes;
}

/// What is known of a tag on the way.
struct Outline {
  std::array<glm::dvec2, 4> corners;
  std::vector<double> widths, contrasts;  ///< of each edge
};

/// Lines through its edges, and where they meet. Coarsely first, for detectors are off by a pixel
/// or two.
bool fit_outline(const cv::Mat& linear, int cells, bool coarse, Outline& tag) {
  const std::array<double, 4> size = cell_sizes(tag.corners, cells);
  std::array<Line, 4> lines;
  tag.widths.clear(), tag.contrasts.clear();
  for (std::size_t i = 0; i < 4; ++i) {
    if (!(size[i] > kLeastCell)) return false;
    const glm::dvec2 &a = tag.corners[i], &b = tag.corners[(i + 1) % 4];
    const double reach = coarse ? std::max(kSearchPixels, kSearchInCells * size[i])
                                : std::clamp(kReachInCells * size[i], kLeastReach, kMostReach);
    const EdgePoints edge =
        coarse ? find_rises(linear, a, b, reach) : find_points(linear, a, b, reach);
    const auto line = fit_robustly(edge, coarse ? kCoarseSpread : kMostSpread);
    if (!line) return false;
    lines[i] = *line;
    tag.widths.push_back(median(edge.widths));
    tag.contrasts.push_back(median(edge.contrasts));
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const Line &before = lines[(i + 3) % 4], &after = lines[i];
    if (std::abs(cross(before.direction, after.direction)) < kLeastSine) return false;
    tag.corners[i] = meet(before, after);
  }
  return true;
}

}  // namespace

std::optional<MeasuredTag> measure_tag(const cv::Mat& linear, std::array<glm::dvec2, 4> corners,
                                       int cells) {
  if (linear.cols < 2 || linear.rows < 2) return std::nullopt;
  Outline tag{corners, {}, {}};
  if (!fit_outline(linear, cells, true, tag)) return std::nullopt;
  for (int round = 0; round < kRounds; ++round) {
    const std::array<glm::dvec2, 4> before = tag.corners;
    if (!fit_outline(linear, cells, false, tag)) return std::nullopt;
    double moved = 0;
    for (std::size_t i = 0; i < 4; ++i)
      moved = std::max(moved, glm::length(tag.corners[i] - before[i]));
    if (moved < 0.005) break;
  }
  const auto [low, high] = std::minmax_element(tag.contrasts.begin(), tag.contrasts.end());
  if (*low < kLeastPeers * *high) return std::nullopt;
  // An edge of something else that lies over the tag.
  const std::array<double, 4> size = cell_sizes(tag.corners, cells);
  const double most = 1.5 * *std::max_element(size.begin(), size.end()) + 1;
  for (std::size_t i = 0; i < 4; ++i)
    if (glm::length(tag.corners[i] - corners[i]) > most) return std::nullopt;
  return MeasuredTag{tag.corners, median(tag.widths)};
}

}  // namespace photohull

// Based on: C. Steger, "An unbiased detector of curvilinear structures", PAMI 1998: points of a
// line are where the first derivative across it vanishes, to a fraction of a pixel, and the second
// one is strongly negative.
#include "masks/mask_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>

#include "core/error.h"
#include "masks/line_chains.h"

namespace photohull {
namespace {

constexpr int kRadius = 3;  // pixels that the Gaussian of deviation 1 reaches
constexpr int kTaps = 2 * kRadius + 1;
constexpr std::uint8_t kLeastCoverage = 6;  // of 255, of the pixel that holds the line's middle
constexpr double kNarrowest = 0.1;          // pixels
constexpr double kLeastBend = 0.4 * kNarrowest * 0.5;  // of the smoothed coverage across a line
// Of a line's smoothed profile: the Gaussian's, and that of a pixel's area.
constexpr double kProfileVariance = 1 + 1.0 / 12;
constexpr double kWithin = 0.55;  // pixels: a line's point belongs to the pixel that holds it
constexpr double kStep = 0.25;    // pixels, of the profile across a line
constexpr int kSteps = 14;        // to either side
constexpr double kFoot = 0.5;     // of the middle's coverage: what lies beside a line has less
constexpr std::uint32_t kFewestPoints = 6;  // of a line
constexpr std::uint8_t kSolid = 128;        // of 255, of a dash
constexpr std::size_t kLargestDash = 48;    // pixels
constexpr double kQuickFoot = 0.7;          // of a pixel's coverage, two or three pixels beside it
constexpr double kHalfLength = 0.75;        // pixels that a point stands for along its line
constexpr double kFullSlack = 0.5;          // pixels

using Kernel = std::array<double, kTaps>;

struct Kernels {
  Kernel smooth, first, second;  ///< a Gaussian of deviation 1 pixel and its derivatives

  Kernels() {
    for (int i = -kRadius; i <= kRadius; ++i) {
      const double g = std::exp(-0.5 * i * i) / std::sqrt(2 * std::numbers::pi);
      const auto at = std::size_t(i + kRadius);
      smooth[at] = g, first[at] = -i * g, second[at] = (i * i - 1) * g;
    }
    // Cut off at three deviations, they must still leave a constant flat.
    double sum = 0;
    for (const double v : second) sum += v;
    for (double& v : second) v -= sum / kTaps;
  }
};

/// Coverage in [0, 1]; beyond the frame it goes on as at its border.
class Coverage {
 public:
  explicit Coverage(const Mask& mask) : mask_(mask) {}

  double at(int x, int y) const {
    const int i = std::clamp(x, 0, mask_.width - 1), j = std::clamp(y, 0, mask_.height - 1);
    return mask_.coverage[std::size_t(j) * std::size_t(mask_.width) + std::size_t(i)] / 255.0;
  }
  double bilinear(double x, double y) const {
    const int i = int(std::floor(x)), j = int(std::floor(y));
    const double u = x - i, v = y - j;
    return (1 - v) * ((1 - u) * at(i, j) + u * at(i + 1, j)) +
           v * ((1 - u) * at(i, j + 1) + u * at(i + 1, j + 1));
  }

 private:
  const Mask& mask_;
};

/// First and second derivatives of the smoothed coverage at a pixel.
struct Derivatives {
  double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
};

Derivatives differentiate(const Mask& mask, int x, int y) {
  static const Kernels k;
  Derivatives d;
  int columns[kTaps];
  for (int i = 0; i < kTaps; ++i) columns[i] = std::clamp(x + i - kRadius, 0, mask.width - 1);
  for (int j = 0; j < kTaps; ++j) {
    const int line = std::clamp(y + j - kRadius, 0, mask.height - 1);
    const std::uint8_t* pixels = &mask.coverage[std::size_t(line) * std::size_t(mask.width)];
    double smooth = 0, first = 0, second = 0;
    for (int i = 0; i < kTaps; ++i) {
      const double c = pixels[columns[i]] / 255.0;
      smooth += c * k.smooth[std::size_t(i)];
      first -= c * k.first[std::size_t(i)];
      second += c * k.second[std::size_t(i)];
    }
    const auto row = std::size_t(j);
    d.x += first * k.smooth[row];
    d.y -= smooth * k.first[row];
    d.xx += second * k.smooth[row];
    d.xy -= first * k.first[row];
    d.yy += smooth * k.second[row];
  }
  return d;
}

/// Pixels to the middle of a line. Newton's step goes too far: the smoothed profile is close to a
/// Gaussian, whose derivatives at a distance x from its middle give a step of
/// x / (1 - x^2 / variance). This solves for x.
double to_middle(double step) {
  const double s = kProfileVariance;
  return step == 0 ? 0 : (std::sqrt(s * s + 4 * step * step * s) - s) / (2 * step);
}

/// Where the line passes the pixel, and across which normal; false where none does.
bool locate(const Derivatives& d, LinePoint& point) {
  const double half = 0.5 * (d.xx - d.yy);
  const double bend = 0.5 * (d.xx + d.yy) - std::hypot(half, d.xy);
  if (!(bend < -kLeastBend)) return false;
  // The eigenvector of the smaller eigenvalue, by the larger of its two forms.
  double nx = d.xy, ny = bend - d.xx;
  if (std::abs(d.xx - bend) < std::abs(d.yy - bend)) nx = bend - d.yy, ny = d.xy;
  const double length = std::hypot(nx, ny);
  if (length > 0)
    nx /= length, ny /= length;
  else
    nx = 1, ny = 0;
  const double offset = to_middle(-(d.x * nx + d.y * ny) / bend);
  if (std::abs(offset * nx) > kWithin || std::abs(offset * ny) > kWithin) return false;
  point = {float(point.x + offset * nx), float(point.y + offset * ny), float(nx), float(ny), 0};
  return true;
}

bool all_equal(const std::uint8_t* pixels, std::uint64_t eight) {
  std::uint64_t found;
  std::memcpy(&found, pixels, sizeof found);
  return found == eight;
}

/// Eight where that many pixels from here on hold nothing, or are the object's as what lies two and
/// three rows above or below is; else 0.
int plain_run(const Mask& mask, int x, int y) {
  if (x + 8 > mask.width) return 0;
  const std::uint8_t* here = &mask.coverage[std::size_t(y) * std::size_t(mask.width) + x];
  if (all_equal(here, 0)) return 8;
  const std::uint64_t full = ~std::uint64_t(0);
  if (!all_equal(here, full)) return 0;
  const auto rows_full = [&](int sign) {
    if (y + 3 * sign < 0 || y + 3 * sign >= mask.height) return false;
    const std::ptrdiff_t row = sign * std::ptrdiff_t(mask.width);
    return all_equal(here + 2 * row, full) && all_equal(here + 3 * row, full);
  };
  return rows_full(1) || rows_full(-1) ? 8 : 0;
}

/// A quick look: does the coverage fall to both sides along one of four directions?
bool may_be_on_line(const Coverage& coverage, int x, int y) {
  constexpr int kSides[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
  const double foot = kQuickFoot * coverage.at(x, y);
  return std::any_of(std::begin(kSides), std::end(kSides), [&](const auto& side) {
    const auto falls = [&](int sign) {
      const int dx = sign * side[0], dy = sign * side[1];
      return coverage.at(x + 3 * dx, y + 3 * dy) < foot ||
             coverage.at(x + 2 * dx, y + 2 * dy) < foot;
    };
    return falls(1) && falls(-1);
  });
}

/// Integral of the coverage from a line's middle to one side, as far as it falls; negative where it
/// does not fall far enough for a line.
double integrate_side(const Coverage& coverage, const LinePoint& p, double middle, double sign) {
  double sum = 0, before = middle;
  for (int i = 1; i <= kSteps; ++i) {
    const double s = sign * kStep * i;
    const double value = coverage.bilinear(p.x + s * p.normal_x, p.y + s * p.normal_y);
    // What rises again once it has fallen belongs to a neighbour.
    if (value > before && before < kFoot * middle) return sum;
    sum += 0.5 * kStep * (before + value);
    before = value;
    if (value == 0) return sum;
  }
  return before < kFoot * middle ? sum : -1;
}

/// Sets the width; false where both sides do not fall off.
bool measure(const Coverage& coverage, LinePoint& p) {
  const double middle = coverage.bilinear(p.x, p.y);
  const double one = integrate_side(coverage, p, middle, 1);
  const double other = integrate_side(coverage, p, middle, -1);
  p.width = float(one + other);
  return one >= 0 && other >= 0 && p.width >= kNarrowest && p.width < kWidestLine;
}

/// Is the piece of foreground around the pixel nothing but a line: a dash of a stem that a hard
/// mask shows here and there? It is small, and no pixel of it is surrounded by others.
bool is_dash(const Mask& mask, int x, int y) {
  const auto holds = [&](int i, int j) {
    return i >= 0 && j >= 0 && i < mask.width && j < mask.height &&
           mask.coverage[std::size_t(j) * std::size_t(mask.width) + i] >= kLeastCoverage;
  };
  if (mask.coverage[std::size_t(y) * std::size_t(mask.width) + x] < kSolid) return false;
  std::vector<std::array<int, 2>> piece{{x, y}};
  for (std::size_t next = 0; next < piece.size(); ++next) {
    int around = 0;
    for (int n = 0; n < 9; ++n) {
      const std::array<int, 2> other{piece[next][0] + n % 3 - 1, piece[next][1] + n / 3 - 1};
      if (!holds(other[0], other[1])) continue;
      ++around;
      if (std::find(piece.begin(), piece.end(), other) == piece.end()) piece.push_back(other);
    }
    if (around == 9 || piece.size() > kLargestDash) return false;
  }
  return true;
}

/// Drops the points of short lines that hang on something thicker: the unevenness of an outline has
/// ridges, too.
std::vector<LinePoint> without_short_lines(const Mask& mask, const std::vector<LinePoint>& points) {
  const std::vector<std::uint32_t> line = lines_of(points);
  std::vector<std::uint32_t> count(points.size(), 0);
  for (const std::uint32_t i : line) ++count[i];
  std::vector<LinePoint> kept, rest;
  for (std::size_t i = 0; i < points.size(); ++i)
    (count[line[i]] >= kFewestPoints ? kept : rest).push_back(points[i]);
  for (const LinePoint& p : rest)
    if (is_dash(mask, std::clamp(int(std::lround(p.x)), 0, mask.width - 1),
                std::clamp(int(std::lround(p.y)), 0, mask.height - 1)))
      kept.push_back(p);
  return kept;
}

double distance_to(const LinePoint& p, double x, double y) {
  const double dx = x - p.x, dy = y - p.y;
  const double across = dx * p.normal_x + dy * p.normal_y;
  const double along = std::abs(dy * p.normal_x - dx * p.normal_y) - kHalfLength;
  return along > 0 ? std::hypot(across, along) : std::abs(across);
}

}  // namespace

std::vector<LinePoint> find_lines(const Mask& mask) {
  PHOTOHULL_CHECK(!mask.empty());
  std::vector<LinePoint> lines;
  const Coverage coverage(mask);
  for (int y = 0; y < mask.height; ++y) {
    const std::uint8_t* row = &mask.coverage[std::size_t(y) * std::size_t(mask.width)];
    for (int x = 0; x < mask.width; ++x) {
      if (const int plain = plain_run(mask, x, y); plain > 0) {
        x += plain - 1;
        continue;
      }
      if (row[x] < kLeastCoverage) continue;
      if (!may_be_on_line(coverage, x, y)) continue;
      LinePoint point{float(x), float(y), 1, 0, 0};
      if (locate(differentiate(mask, x, y), point) && measure(coverage, point))
        lines.push_back(point);
    }
  }
  return without_short_lines(mask, lines);
}

std::vector<LinePoint> sure_lines(const Mask& mask, std::vector<LinePoint> lines) {
  std::erase_if(lines, [&](const LinePoint& p) {
    const int x = std::clamp(int(std::lround(p.x)), 0, mask.width - 1);
    const int y = std::clamp(int(std::lround(p.y)), 0, mask.height - 1);
    return mask.coverage[std::size_t(y) * std::size_t(mask.width) + x] < kSureForeground;
  });
  return lines;
}

double line_slack(double width) { return kFullSlack * std::clamp(kWidestLine - width, 0.0, 1.0); }

void widen_lines(const std::vector<LinePoint>& lines, Mask& mask) {
  for (const LinePoint& p : lines) {
    const double half = 0.5 * p.width + line_slack(p.width);
    const double reach = half + 0.5 + kHalfLength;
    for (int y = std::max(0, int(std::ceil(p.y - reach)));
         y <= std::min(mask.height - 1, int(p.y + reach)); ++y)
      for (int x = std::max(0, int(std::ceil(p.x - reach)));
           x <= std::min(mask.width - 1, int(p.x + reach)); ++x) {
        const double share = std::clamp(0.5 + half - distance_to(p, x, y), 0.0, 1.0);
        std::uint8_t& value = mask.coverage[std::size_t(y) * std::size_t(mask.width) + x];
        value = std::max(value, std::uint8_t(std::lround(255 * share)));
      }
  }
}

}  // namespace photohull

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <optional>

#include "calib/find_board_parts.h"
#include "core/median.h"

namespace photohull {
namespace {

struct Dot {
  glm::dvec2 middle{0.0};
  double area = 0;  ///< share of its cell
};

/// Light at the rim of a cell as a plane over the picture, least squares.
struct Plane {
  glm::dmat3 normal{0.0};
  glm::dvec3 right{0.0};

  void add(const glm::dvec2& at, double value) {
    const glm::dvec3 v(at, 1);
    normal += glm::outerProduct(v, v);
    right += value * v;
  }
  glm::dvec3 solve() const { return glm::inverse(normal) * right; }
};

/// Calls `use(offset from the middle, grid position, light)` for each pixel of the cell that `cell`
/// (a column a step of the grid, in pixels) spans around `middle`. False beyond the picture.
template <typename Use>
bool over_cell(const cv::Mat& linear, const glm::dvec2& middle, const glm::dmat2& cell,
               const Use& use) {
  const glm::dmat2 to_grid = glm::inverse(cell);
  const glm::dvec2 reach = 0.5 * (glm::abs(cell[0]) + glm::abs(cell[1]));
  const glm::dvec2 low = middle - reach, high = middle + reach;
  if (!(low.x >= 0 && low.y >= 0 && high.x <= linear.cols - 1 && high.y <= linear.rows - 1))
    return false;
  for (int y = int(std::ceil(low.y)); y <= int(high.y); ++y)
    for (int x = int(std::ceil(low.x)); x <= int(high.x); ++x) {
      const glm::dvec2 offset = glm::dvec2(x, y) - middle, g = to_grid * offset;
      if (std::max(std::abs(g.x), std::abs(g.y)) <= 0.5)
        use(offset, g, double(linear.at<float>(y, x)));
    }
  return true;
}

std::optional<Dot> measure_dot(const cv::Mat& linear, glm::dvec2 middle, const glm::dmat2& cell) {
  constexpr double kRim = 0.44, kCore = 0.12;  // of a cell
  constexpr double kLeastContrast = 0.02;      // of full light
  constexpr double kNothing = 0.05;            // darkness that noise may feign
  constexpr int kRounds = 3;
  Dot dot;
  for (int round = 0; round < kRounds; ++round) {
    Plane rim;
    std::vector<double> core;
    const bool inside =
        over_cell(linear, middle, cell, [&](const glm::dvec2& d, const glm::dvec2& g, double v) {
          const double out = std::max(std::abs(g.x), std::abs(g.y));
          if (out >= kRim) rim.add(d, v);
          if (out <= kCore) core.push_back(v);
        });
    if (!inside || core.empty() || !(glm::determinant(rim.normal) > 0)) return std::nullopt;
    const glm::dvec3 light = rim.solve();
    const double dark = median(core);
    if (!(light.z - dark > kLeastContrast)) return std::nullopt;
    double sum = 0;
    glm::dvec2 moment(0.0);
    over_cell(linear, middle, cell, [&](const glm::dvec2& d, const glm::dvec2&, double v) {
      const double bright = glm::dot(light, glm::dvec3(d, 1));
      const double darkness = (bright - v) / std::max(bright - dark, 1e-6);
      if (darkness < kNothing) return;
      sum += darkness;
      moment += darkness * d;
    });
    if (!(sum > 0)) return std::nullopt;
    middle += moment / sum;
    dot = {middle, sum / std::abs(glm::determinant(cell))};
  }
  return dot;
}

}  // namespace

void measure_dots(const cv::Mat& linear, const std::vector<cv::Point2f>& found,
                  const BoardSpec& board, BoardView& view) {
  const auto at = [&](int i, int j) {
    const cv::Point2f& p = found[std::size_t(j) * board.columns + i];
    return glm::dvec2(p.x, p.y);
  };
  std::vector<double> radii;
  for (int j = 0; j < board.rows; ++j)
    for (int i = 0; i < board.columns; ++i) {
      // Differences to the neighbours: central ones where there are two.
      const int left = std::max(i - 1, 0), right = std::min(i + 1, board.columns - 1);
      const int above = std::max(j - 1, 0), below = std::min(j + 1, board.rows - 1);
      const glm::dmat2 cell((at(right, j) - at(left, j)) / double(right - left),
                            (at(i, below) - at(i, above)) / double(below - above));
      if (!(std::abs(glm::determinant(cell)) > 9)) continue;  // square pixels
      const auto dot = measure_dot(linear, at(i, j), cell);
      if (!dot) continue;
      view.points.emplace_back(board.square * i, board.square * j, 0);
      view.pixels.push_back(dot->middle);
      radii.push_back(board.square * std::sqrt(dot->area / std::numbers::pi));
    }
  view.dot_radius = median(radii);
}

}  // namespace photohull

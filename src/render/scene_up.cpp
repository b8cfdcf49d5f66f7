#include "render/scene_up.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace photohull::render {
namespace {

constexpr int kRounds = 50;              // of the power iteration
constexpr double kClearlyMore = 0.1;     // share of an axis over another's
constexpr double kLeastAgreement = 0.3;  // of the axes' signs
constexpr double kLeastHeight = 0.1;     // of the cameras, of their distance

struct SharedAxis {
  glm::dvec3 axis{0.0};
  double share = 0;  ///< how much the cameras have it in common, whatever its sign; up to 1
  double sign = 0;   ///< mean of the signs
};

/// Of the cameras' axes to the right (row 0) or down (row 1).
SharedAxis shared_axis(std::span<const Camera> cameras, int row) {
  std::vector<glm::dvec3> axes;
  for (const Camera& camera : cameras) {
    const glm::dmat3& r = camera.cam_from_world.rotation;
    axes.emplace_back(r[0][row], r[1][row], r[2][row]);
  }
  const double count = double(axes.size());
  SharedAxis out{axes.front()};
  for (int round = 0; round < kRounds; ++round) {
    glm::dvec3 sum(0);
    for (const glm::dvec3& axis : axes) sum += glm::dot(axis, out.axis) / count * axis;
    out.share = glm::length(sum);
    if (out.share > 0) out.axis = sum / out.share;
  }
  for (const glm::dvec3& axis : axes) out.sign += glm::dot(axis, out.axis) / count;
  return out;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

glm::dvec3 scene_up(std::span<const Camera> cameras, const glm::dvec3& middle) {
  if (cameras.empty()) return {0, 0, 1};
  const SharedAxis across = shared_axis(cameras, 0), down = shared_axis(cameras, 1);
  const bool sideways = across.share > down.share + kClearlyMore;
  const glm::dvec3& axis = sideways ? across.axis : down.axis;
  if (!sideways && std::abs(down.sign) > kLeastAgreement) return down.sign > 0 ? -axis : axis;
  double height = 0;
  std::vector<double> ways;
  for (const Camera& camera : cameras) {
    const glm::dvec3 centre = camera.center() - middle;
    height += glm::dot(centre, axis) / double(cameras.size());
    ways.push_back(glm::length(centre));
  }
  const bool above = std::abs(height) > kLeastHeight * median(std::move(ways));
  const double side = above ? height : axis.x + axis.y + axis.z;
  return side < 0 ? -axis : axis;
}

}  // namespace photohull::render

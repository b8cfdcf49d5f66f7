// Depth maps as in L. Williams, "Casting curved shadows on curved surfaces", SIGGRAPH 1978.
#include "texture/view_maps.h"

#include <algorithm>
#include <cmath>

namespace photohull::texture {
namespace {

constexpr double kNear = 1e-4;  // of the mesh's farthest depth: what is nearer is cut off
// Pixels' footprints that depths step by where a part stands before another: two planes that are
// seen at 60 degrees and meet differ by less.
constexpr float kStep = 4;
constexpr double kSameSurface = 2;  // footprints

/// Corners in the camera's frame; what lies before the plane z = near goes. Up to four corners.
int clip(const std::array<glm::dvec3, 3>& corners, double near, std::array<glm::dvec3, 4>& out) {
  int count = 0;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 &a = corners[i], &b = corners[(i + 1) % 3];
    if (a.z >= near) out[count++] = a;
    if ((a.z >= near) != (b.z >= near)) out[count++] = glm::mix(a, b, (near - a.z) / (b.z - a.z));
  }
  return count;
}

}  // namespace

ViewMaps::ViewMaps(const TriMesh& mesh, const ViewPixels& pixels)
    : width_(pixels.width()),
      height_(pixels.height()),
      focal_(pixels.camera().intrinsics.fx),
      inverse_(std::size_t(width_) * height_, 0.0f),
      clearance_(inverse_.size(), kFullClearance) {
  draw(mesh, pixels.camera());
  find_edges(pixels);
  spread_clearance();
}

void ViewMaps::draw(const TriMesh& mesh, const Camera& camera) {
  std::vector<glm::dvec3> points(mesh.positions.size());
  double far = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = camera.to_camera(mesh.world(i));
    far = std::max(far, points[i].z);
  }
  if (!(far > 0)) return;  // all of it is behind the camera
  const Intrinsics& k = camera.intrinsics;
  const auto project = [&](const glm::dvec3& p) {
    return Projected((k.fx * p.x + k.skew * p.y) / p.z + k.cx, k.fy * p.y / p.z + k.cy, 1 / p.z);
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    std::array<glm::dvec3, 4> corners;
    const int count = clip({points[a], points[b], points[c]}, kNear * far, corners);
    for (int i = 2; i < count; ++i)
      draw_face({{project(corners[0]), project(corners[i - 1]), project(corners[i])}});
  }
}

void ViewMaps::draw_face(const FaceInImage& face) {
  FacePixels(face, width_, height_).each([&](int x, int y) {
    const glm::dvec3 weights = image_weights(face, {double(x), double(y)});
    float& nearest = inverse_[at(x, y)];
    nearest = std::max(nearest, float(inverse_depth(face, weights)));
  });
}

/// One over the depth is linear over a plane, so that its second difference tells steps from
/// slopes.
void ViewMaps::find_edges(const ViewPixels& pixels) {
  const auto steps = [&](std::size_t i, std::size_t before, std::size_t after) {
    const float here = inverse_[i], limit = kStep * here / float(focal_);
    return inverse_[before] > 0 && inverse_[after] > 0 &&
           std::abs(inverse_[before] - 2 * here + inverse_[after]) > limit;
  };
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const std::size_t i = at(x, y);
      std::uint8_t& clear = clearance_[i];
      if (inverse_[i] == 0 || !pixels.known(x, y)) {
        clear = 0;
        continue;
      }
      const std::size_t row = std::size_t(width_);
      if (x > 0 && x + 1 < width_ && steps(i, i - 1, i + 1)) clear = 1;
      if (y > 0 && y + 1 < height_ && steps(i, i - row, i + row)) clear = 1;
      if (const std::optional<float> inside = pixels.inside(x, y))
        clear = std::uint8_t(std::clamp(int(std::floor(*inside + 0.5f)), 0, int(clear)));
    }
}

/// A pixel is clear by one more than the least clear of its eight neighbours.
void ViewMaps::spread_clearance() {
  const auto pass = [&](int x, int y, int back) {
    std::uint8_t& clear = clearance_[at(x, y)];
    const auto bound = [&](int nx, int ny) {
      if (on_image(nx, ny)) clear = std::min<std::uint8_t>(clear, clearance_[at(nx, ny)] + 1);
    };
    bound(x + back, y);
    for (int dx = -1; dx <= 1; ++dx) bound(x + dx, y + back);
  };
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) pass(x, y, -1);
  for (int y = height_ - 1; y >= 0; --y)
    for (int x = width_ - 1; x >= 0; --x) pass(x, y, 1);
}

int ViewMaps::clearance_of(int x, int y, double inverse) const {
  if (!on_image(x, y)) return 0;
  const double seen = inverse_[at(x, y)];
  return std::abs(inverse - seen) <= kSameSurface * seen / focal_ ? clearance(x, y) : 0;
}

}  // namespace photohull::texture

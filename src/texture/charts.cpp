#include "texture/charts.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "texture/face_views.h"
#include "texture/surface.h"

namespace photohull::texture {
namespace {

constexpr double kOverlap = 0.1;  // pixels by which triangles may cover the same pixel centre

struct Bounds {
  glm::dvec2 low{1e300}, high{-1e300};

  Bounds with(const FaceInImage& face) const {
    Bounds out = *this;
    for (int i = 0; i < 3; ++i) {
      out.low = glm::min(out.low, face.at(i));
      out.high = glm::max(out.high, face.at(i));
    }
    return out;
  }
};

/// The charts of one plane.
class PlaneCharts {
 public:
  PlaneCharts(const TriMesh& mesh, const std::vector<std::array<std::uint32_t, 3>>& neighbours,
              const Planes& planes, std::uint32_t plane, int most_edge,
              std::vector<std::uint32_t> faces)
      : mesh_(mesh),
        neighbours_(neighbours),
        planes_(planes),
        plane_(plane),
        most_(most_edge - 2 * kGutter - 2),
        faces_(std::move(faces)) {
    Bounds all;
    for (const std::uint32_t face : faces_) all = all.with(project(face));
    if (faces_.empty()) return;
    low_ = glm::ivec2(glm::floor(all.low)) - 1;
    cells_ = glm::ivec2(glm::ceil(all.high)) + 2 - low_;
    owner_.resize(std::size_t(cells_.x) * cells_.y, 0);
  }

  std::vector<Chart> make(std::vector<std::uint8_t>& taken) {
    std::vector<Chart> charts;
    for (const std::uint32_t seed : faces_)
      if (!taken[seed]) {
        ++chart_;
        charts.push_back(grow(seed, taken));
      }
    return charts;
  }

 private:
  FaceInImage project(std::uint32_t face) const {
    FaceInImage seen;
    PHOTOHULL_CHECK(planes_.projectors[plane_].project(mesh_, face, seen));
    return seen;
  }

  Chart grow(std::uint32_t seed, std::vector<std::uint8_t>& taken) {
    Chart chart;
    chart.plane = plane_;
    bounds_ = {};
    take(seed, taken, chart);
    for (std::size_t next = 0; next < chart.faces.size(); ++next)
      for (const std::uint32_t other : neighbours_[chart.faces[next]])
        if (other != kNoFace && planes_.of_face[other] == plane_ && !taken[other])
          take(other, taken, chart);
    chart.low = glm::ivec2(glm::floor(bounds_.low)) - kGutter;
    chart.size = glm::ivec2(glm::ceil(bounds_.high)) + 1 + kGutter - chart.low;
    return chart;
  }

  /// Unless it covers what others of the chart do, or makes it too large.
  void take(std::uint32_t face, std::vector<std::uint8_t>& taken, Chart& chart) {
    FaceInImage seen = project(face);
    const Bounds grown = bounds_.with(seen);
    const glm::dvec2 size = grown.high - grown.low;
    if (!chart.faces.empty() && std::max(size.x, size.y) > most_) return;
    for (Projected& corner : seen.corners) corner -= glm::dvec3(low_, 0);
    bool free = true;
    FacePixels(seen, cells_.x, cells_.y, -kOverlap).each([&](int x, int y) {
      if (owner(x, y) == chart_) free = false;
    });
    if (!free) return;
    FacePixels(seen, cells_.x, cells_.y, -kOverlap).each([&](int x, int y) {
      owner(x, y) = chart_;
    });
    taken[face] = 1;
    bounds_ = grown;
    chart.faces.push_back(face);
  }

  std::int32_t& owner(int x, int y) { return owner_[std::size_t(y) * cells_.x + x]; }

  const TriMesh& mesh_;
  const std::vector<std::array<std::uint32_t, 3>>& neighbours_;
  const Planes& planes_;
  std::uint32_t plane_;
  double most_;  // pixels along each side of a chart
  std::vector<std::uint32_t> faces_;
  glm::ivec2 low_{0}, cells_{0};
  std::vector<std::int32_t> owner_;  // the last chart that covers each pixel; 0: none
  std::int32_t chart_ = 0;
  Bounds bounds_;  // of the chart
};

}  // namespace

std::vector<Chart> make_charts(const TriMesh& mesh,
                               const std::vector<std::array<std::uint32_t, 3>>& neighbours,
                               const Planes& planes, int most_edge, Progress& progress) {
  std::vector<std::vector<std::uint32_t>> faces(planes.projectors.size());
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) faces[planes.of_face[f]].push_back(f);
  std::vector<std::vector<Chart>> made(planes.projectors.size());
  std::vector<std::uint8_t> taken(mesh.triangles.size(), 0);
  for_views(made.size(), [&](std::size_t p) {
    progress.check_cancelled();
    made[p] =
        PlaneCharts(mesh, neighbours, planes, std::uint32_t(p), most_edge, std::move(faces[p]))
            .make(taken);
  });
  std::vector<Chart> charts;
  for (std::vector<Chart>& some : made)
    for (Chart& chart : some) charts.push_back(std::move(chart));
  return charts;
}

}  // namespace photohull::texture

#include "texture/page_plan.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "texture/surface.h"

namespace photohull::texture {
namespace {

constexpr double kGutterPixels = 1.5;  // around triangles, in which texels show their planes
constexpr double kBand = 8;            // texels from a seam in which both sides are blended

/// A side of a triangle that is a seam.
struct FaceSeam {
  std::uint32_t face, seam;
  int side;  // of the seam: which of its faces it is
  bool operator<(const FaceSeam& o) const { return face != o.face ? face < o.face : seam < o.seam; }
};

std::vector<FaceSeam> seams_by_face(std::span<const Seam> seams) {
  std::vector<FaceSeam> all;
  for (std::uint32_t s = 0; s < seams.size(); ++s)
    for (int side = 0; side < 2; ++side) all.push_back({seams[s].faces[side], s, side});
  std::sort(all.begin(), all.end());
  return all;
}

/// The nearest seam of each texel of a chart.
class ChartBand {
 public:
  ChartBand(const TriMesh& mesh, const Planes& planes, const Chart& chart)
      : mesh_(mesh),
        planes_(planes),
        chart_(chart),
        nearest_(std::size_t(chart.size.x) * chart.size.y, {0, 1e9f}) {}

  void add(const Seam& seam, int side) {
    const std::uint32_t face = seam.faces[side];
    const FaceInImage seen = on_chart(mesh_, planes_, chart_, face);
    std::array<glm::dvec2, 2> ends{};
    glm::dvec2 third(0);
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t vertex = mesh_.triangles[face][i];
      (vertex == seam.vertices[0]   ? ends[0]
       : vertex == seam.vertices[1] ? ends[1]
                                    : third) = seen.at(i);
    }
    const std::uint32_t other = planes_.of_face[seam.faces[1 - side]];
    const glm::dvec2 low = glm::min(ends[0], ends[1]) - kBand,
                     high = glm::max(ends[0], ends[1]) + kBand;
    const glm::dvec2 line = ends[1] - ends[0];
    const double squared = glm::dot(line, line);
    const auto cross = [&](const glm::dvec2& p) {
      return line.x * (p.y - ends[0].y) - line.y * (p.x - ends[0].x);
    };
    const double inside = cross(third) < 0 ? -1 : 1;
    for (int y = std::max(0, int(std::ceil(low.y)));
         y <= std::min(chart_.size.y - 1, int(std::floor(high.y))); ++y)
      for (int x = std::max(0, int(std::ceil(low.x)));
           x <= std::min(chart_.size.x - 1, int(std::floor(high.x))); ++x) {
        const glm::dvec2 p(x, y);
        const double t =
            squared > 0 ? std::clamp(glm::dot(p - ends[0], line) / squared, 0.0, 1.0) : 0;
        const double distance = glm::distance(p, glm::mix(ends[0], ends[1], t));
        Near& near = nearest_[std::size_t(y) * chart_.size.x + x];
        if (distance >= std::min(kBand, double(near.distance))) continue;
        const bool beyond = t > 0 && t < 1 && inside * cross(p) < 0;
        near = {other, float(distance), beyond};
      }
  }

  /// Those of texels that show something.
  std::vector<BandTexel> collect(const PagePlan& plan) const {
    std::vector<BandTexel> band;
    for (int y = 0; y < chart_.size.y; ++y)
      for (int x = 0; x < chart_.size.x; ++x) {
        const Near& near = nearest_[std::size_t(y) * chart_.size.x + x];
        if (near.distance >= kBand || plan.face(chart_.place + glm::ivec2(x, y)) == kNoFace)
          continue;
        const double signed_distance = near.beyond ? -double(near.distance) : near.distance;
        band.push_back({{x, y}, near.other, float(0.5 * (1 - signed_distance / kBand))});
      }
    return band;
  }

 private:
  struct Near {
    std::uint32_t other;  // the plane of the seam's other side
    float distance;
    bool beyond = false;
  };

  const TriMesh& mesh_;
  const Planes& planes_;
  const Chart& chart_;
  std::vector<Near> nearest_;
};

}  // namespace

FaceInImage on_chart(const TriMesh& mesh, const Planes& planes, const Chart& chart,
                     std::uint32_t face) {
  FaceInImage seen;
  PHOTOHULL_CHECK(planes.projectors[chart.plane].project(mesh, face, seen));
  for (Projected& corner : seen.corners) corner -= glm::dvec3(chart.low, 0);
  return seen;
}

PagePlan::PagePlan(const TriMesh& mesh, const Planes& planes, std::span<const Chart> charts,
                   std::span<const Seam> seams, std::uint32_t page, const glm::ivec2& size)
    : size_(size), faces_(std::size_t(size.x) * size.y, kNoFace), bands_(charts.size()) {
  for (std::uint32_t c = 0; c < charts.size(); ++c)
    if (charts[c].page == page) charts_.push_back(c);
  const std::vector<FaceSeam> by_face = seams_by_face(seams);
  tbb::parallel_for(std::size_t(0), charts_.size(), [&](std::size_t i) {
    const Chart& chart = charts[charts_[i]];
    draw_chart(mesh, planes, chart);
    ChartBand band(mesh, planes, chart);
    bool any = false;
    for (const std::uint32_t face : chart.faces)
      for (auto s = std::lower_bound(by_face.begin(), by_face.end(), FaceSeam{face, 0, 0});
           s != by_face.end() && s->face == face; ++s) {
        band.add(seams[s->seam], s->side);
        any = true;
      }
    if (any) bands_[charts_[i]] = band.collect(*this);
  });
}

void PagePlan::draw_chart(const TriMesh& mesh, const Planes& planes, const Chart& chart) {
  for (const double margin : {0.0, kGutterPixels})
    for (const std::uint32_t face : chart.faces) {
      const FaceInImage seen = on_chart(mesh, planes, chart, face);
      FacePixels(seen, chart.size.x, chart.size.y, margin).each([&](int x, int y) {
        std::uint32_t& shown = faces_[index(chart.place + glm::ivec2(x, y))];
        if (shown == kNoFace) shown = face;
      });
    }
}

}  // namespace photohull::texture

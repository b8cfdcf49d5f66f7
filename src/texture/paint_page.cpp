#include "texture/paint_page.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>
#include <vector>

#include "texture/face_views.h"
#include "texture/spread_colours.h"
#include "texture/surface.h"
#include "texture/view_maps.h"

namespace photohull::texture {
namespace {

constexpr float kCodes = 65535;

/// A photograph with what it shows of the mesh; nothing, for planes that are none.
struct Source {
  Source(const Paint& paint, std::size_t plane) {
    if (plane >= paint.views.size()) return;
    pixels.emplace(paint.views[plane], paint.scale);
    maps.emplace(paint.mesh, *pixels);
  }
  std::optional<ViewPixels> pixels;
  std::optional<ViewMaps> maps;
};

/// How much of a colour is the photograph's.
float share_of(int clearance) {
  if (clearance < kLeastClearance) return 0;
  return float(clearance - kLeastClearance + 1) / float(kFullClearance - kLeastClearance + 1);
}

/// A point of the surface that a texel shows.
struct Point {
  std::uint32_t face = kNoFace;
  glm::dvec3 weights{0};  // of its corners
  double inverse = 1;     // one over its depth
  glm::vec3 position{0};  // relative to the mesh's origin
};

class Painter {
 public:
  Painter(const Paint& paint, const PagePlan& plan)
      : paint_(paint), plan_(plan), roots_(std::size_t(plan.size().x) * plan.size().y) {}

  void paint_plane(std::size_t plane) {
    if (plan_.charts_of_plane()[plane].empty()) return;
    const Source source(paint_, plane);
    std::uint32_t hint = 0;
    std::int64_t texels = 0, filled = 0;
    for (const std::uint32_t c : plan_.charts_of_plane()[plane]) {
      const Chart& chart = paint_.charts[c];
      for (int y = 0; y < chart.size.y; ++y)
        for (int x = 0; x < chart.size.x; ++x) {
          if (plan_.face(chart.place + glm::ivec2(x, y)) == kNoFace) continue;
          const Point point = point_of(chart, {x, y});
          const float share = own_share(source, chart, {x, y}, point);
          glm::vec3 root(0);
          if (share > 0) root += share * source.pixels->root(chart.low.x + x, chart.low.y + y);
          if (share < 1) root += (1 - share) * fill(point, hint);
          for (int i = 0; i < 3; ++i)
            root += float(point.weights[i]) *
                    paint_.levels.at(paint_.mesh.triangles[point.face][i], std::uint32_t(plane));
          set(plan_.index(chart.place + glm::ivec2(x, y)), root);
          ++texels;
          filled += share == 0;
        }
    }
    texels_ += texels;
    filled_ += filled;
  }

  /// The plane's colours on the other sides of its seams.
  void blend_plane(std::size_t plane) {
    if (plan_.band_of_plane()[plane].empty()) return;
    const Source source(paint_, plane);
    const Projector& projector = paint_.planes.projectors[plane];
    std::uint32_t hint = 0;
    for (const BandTexel& band : plan_.band_of_plane()[plane]) {
      const Chart& chart = paint_.charts[band.chart];
      const Point point = point_of(chart, band.texel);
      Projected p;
      if (!projector.project(point.position, p)) continue;
      const float share = source.maps ? share_between(*source.maps, p) : 0;
      glm::vec3 root(0);
      if (share > 0) root += share * source.pixels->root_between(glm::dvec2(p));
      if (share < 1) root += (1 - share) * fill(point, hint);
      const Seam& seam = paint_.seams[band.seam];
      root += glm::mix(paint_.levels.at(seam.vertices[0], std::uint32_t(plane)),
                       paint_.levels.at(seam.vertices[1], std::uint32_t(plane)), band.along);
      const std::size_t at = plan_.index(chart.place + band.texel);
      set(at, glm::mix(get(at), root, band.share));
    }
  }

  PaintedPage finish() const {
    PaintedPage out{{plan_.size().x, plan_.size().y, {}}, texels_, filled_};
    std::vector<std::uint8_t> shown(roots_.size());
    out.page.rgb.resize(3 * roots_.size());
    for (int y = 0; y < plan_.size().y; ++y)
      for (int x = 0; x < plan_.size().x; ++x) {
        const std::size_t i = plan_.index({x, y});
        shown[i] = plan_.face({x, y}) != kNoFace;
        const glm::vec3 root = get(i);
        for (int c = 0; c < 3; ++c)
          out.page.rgb[3 * i + std::size_t(c)] =
              shown[i]
                  ? std::uint8_t(std::lround(255 * srgb_from_linear(double(root[c]) * root[c])))
                  : 0;
      }
    spread_colours(shown, out.page);
    return out;
  }

 private:
  Point point_of(const Chart& chart, const glm::ivec2& texel) const {
    Point out;
    out.face = plan_.face(chart.place + texel);
    const FaceInImage seen = on_chart(paint_.mesh, paint_.planes, chart, out.face);
    const glm::dvec3 weights = image_weights(seen, glm::dvec2(texel));
    out.inverse = inverse_depth(seen, weights);
    out.weights = bounded(surface_weights(seen, weights));
    for (int i = 0; i < 3; ++i)
      out.position +=
          float(out.weights[i]) * paint_.mesh.positions[paint_.mesh.triangles[out.face][i]];
    return out;
  }

  /// Texels beside slivers may lie many of their widths away.
  static glm::dvec3 bounded(const glm::dvec3& weights) {
    constexpr double kBeyond = 1;
    const bool near = glm::all(glm::lessThan(glm::abs(weights - 0.5), glm::dvec3(0.5 + kBeyond)));
    if (near) return weights;
    const glm::dvec3 inside = glm::clamp(weights, 0.0, 1.0);
    const double sum = inside.x + inside.y + inside.z;
    return sum > 0 ? inside / sum : glm::dvec3(1.0 / 3);
  }

  static float own_share(const Source& source, const Chart& chart, const glm::ivec2& texel,
                         const Point& point) {
    if (!source.maps) return 0;
    return share_of(
        source.maps->clearance_of(chart.low.x + texel.x, chart.low.y + texel.y, point.inverse));
  }

  static float share_between(const ViewMaps& maps, const Projected& p) {
    const glm::dvec2 pixel = glm::round(glm::dvec2(p));
    if (!(std::abs(pixel.x) < 1e6 && std::abs(pixel.y) < 1e6)) return 0;
    return share_of(maps.clearance_of(int(pixel.x), int(pixel.y), p.z));
  }

  glm::vec3 fill(const Point& point, std::uint32_t& hint) const {
    return paint_.fill.root(paint_.mesh.origin + glm::dvec3(point.position), hint);
  }

  void set(std::size_t at, const glm::vec3& root) {
    for (int c = 0; c < 3; ++c)
      roots_[at][std::size_t(c)] = std::uint16_t(kCodes * std::clamp(root[c], 0.0f, 1.0f) + 0.5f);
  }
  glm::vec3 get(std::size_t at) const {
    return glm::vec3(roots_[at][0], roots_[at][1], roots_[at][2]) / kCodes;
  }

  const Paint& paint_;
  const PagePlan& plan_;
  std::vector<std::array<std::uint16_t, 3>> roots_;
  std::atomic<std::int64_t> texels_{0}, filled_{0};
};

}  // namespace

PaintedPage paint_page(const Paint& paint, const PagePlan& plan, Progress& progress) {
  Painter painter(paint, plan);
  for_views(paint.planes.projectors.size(), [&](std::size_t plane) {
    progress.check_cancelled();
    painter.paint_plane(plane);
  });
  for_views(paint.planes.projectors.size(), [&](std::size_t plane) {
    progress.check_cancelled();
    painter.blend_plane(plane);
  });
  return painter.finish();
}

}  // namespace photohull::texture

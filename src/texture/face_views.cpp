#include "texture/face_views.h"

#include <algorithm>
#include <cmath>

#include "texture/surface.h"

namespace photohull::texture {
namespace {

constexpr double kLeastCosine = 0.2;       // between normal and viewing direction
constexpr double kColourDeviation = 0.12;  // in roots of linear light

/// What one photograph shows of a triangle.
struct Shown {
  int pixels = 0, clear = 0, clearance = 0;  // clearance: sum over the clear ones
  glm::vec3 colour{0};                       // sum, roots of linear light
};

/// A triangle that does not face the camera.
constexpr float kAway = -1;

/// Quality of every triangle in one photograph, beside nothing; 0: it faces the camera, and is not
/// clear to see.
class ViewJudge {
 public:
  ViewJudge(const TriMesh& mesh, const ViewSource& source, double sharpness)
      : mesh_(mesh),
        pixels_(source.pixels),
        maps_(source.maps),
        projector_(source.projector),
        eye_(pixels_.camera().center() - mesh.origin),
        sharp_(std::pow(sharpness, 4)) {}

  float quality(std::size_t face) const {
    const glm::dvec3 area = double_area(mesh_, face);
    const glm::dvec3 way = eye_ - glm::dvec3(mesh_.positions[mesh_.triangles[face][0]]);
    const double size = glm::length(area), distance = glm::length(way);
    if (!(size > 0) || !(glm::dot(area, way) > kLeastCosine * size * distance)) return kAway;
    FaceInImage seen;
    if (!projector_.project(mesh_, face, seen) || !on_image(seen)) return kAway;
    const double pixels = seen.double_area();
    if (!(pixels > 0)) return kAway;
    const Shown shown = look(seen);
    if (shown.clear == 0) return 0;
    const double share = double(shown.clear) / shown.pixels;
    const double clear = double(shown.clearance) / shown.clear / kFullClearance;
    return float(share * share * clear * sharp_ * pixels / size * agreement(face, shown));
  }

 private:
  bool on_image(const FaceInImage& seen) const {
    for (int i = 0; i < 3; ++i)
      if (!pixels_.camera().on_image(seen.at(i))) return false;
    return true;
  }

  Shown look(const FaceInImage& seen) const {
    Shown shown;
    const auto add = [&](int x, int y) {
      const glm::dvec3 weights = image_weights(seen, {double(x), double(y)});
      const int clear = maps_.clearance_of(x, y, inverse_depth(seen, weights));
      ++shown.pixels;
      if (clear < kLeastClearance) return;
      ++shown.clear;
      shown.clearance += clear;
      shown.colour += pixels_.root(x, y);
    };
    FacePixels(seen, pixels_.width(), pixels_.height()).each(add);
    if (shown.pixels == 0) {
      const glm::dvec2 middle = (seen.at(0) + seen.at(1) + seen.at(2)) / 3.0;
      const glm::dvec2 pixel = glm::round(middle);
      if (std::abs(pixel.x) < 1e6 && std::abs(pixel.y) < 1e6) add(int(pixel.x), int(pixel.y));
    }
    return shown;
  }

  double agreement(std::size_t face, const Shown& shown) const {
    if (mesh_.colours.empty()) return 1;
    const auto& [a, b, c] = mesh_.triangles[face];
    const glm::vec3 own = root_of((mesh_.colours[a] + mesh_.colours[b] + mesh_.colours[c]) / 3.0f);
    const double off = glm::distance(own, shown.colour / float(shown.clear)) / kColourDeviation;
    return 1 / (1 + off * off);
  }

  const TriMesh& mesh_;
  const ViewPixels& pixels_;
  const ViewMaps& maps_;
  const Projector& projector_;
  glm::dvec3 eye_;  // relative to the mesh's origin
  double sharp_;
};

}  // namespace

FaceViews find_face_views(const TriMesh& mesh, std::span<const PreparedView> views,
                          ViewSources& sources, Progress& progress) {
  std::vector<std::vector<float>> quality(views.size());
  for_views(views.size(), [&](std::size_t v) {
    progress.check_cancelled();
    const std::shared_ptr<const ViewSource> source = sources.get(v);
    const ViewJudge judge(mesh, *source, views[v].sharpness);
    for (std::size_t face = 0; face < mesh.triangles.size(); ++face)
      quality[v].push_back(judge.quality(face));
  });
  FaceViews out;
  for (std::size_t face = 0; face < mesh.triangles.size(); ++face) {
    float best = 0;
    for (std::size_t v = 0; v < views.size(); ++v) best = std::max(best, quality[v][face]);
    out.clear.push_back(best > 0);
    out.first.push_back(out.views.size());
    for (std::size_t v = 0; v < views.size(); ++v)
      if (const float q = quality[v][face]; best > 0 ? q > 0 : q == 0)
        out.views.push_back({std::uint32_t(v), best > 0 ? q / best : 0});
  }
  out.first.push_back(out.views.size());
  return out;
}

std::vector<float> weights_at_vertices(const TriMesh& mesh, const FaceViews& views,
                                       std::uint32_t view) {
  std::vector<float> sum(mesh.positions.size(), 0.0f), count(sum);
  for (std::size_t face = 0; face < mesh.triangles.size(); ++face) {
    const auto all = views.of(face);
    const auto found =
        std::lower_bound(all.begin(), all.end(), view,
                         [](const FaceView& v, std::uint32_t i) { return v.view < i; });
    const float quality = found != all.end() && found->view == view ? found->quality : 0;
    for (const std::uint32_t vertex : mesh.triangles[face]) {
      sum[vertex] += quality;
      count[vertex] += 1;
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i)
    if (count[i] > 0) sum[i] /= count[i];
  return sum;
}

}  // namespace photohull::texture

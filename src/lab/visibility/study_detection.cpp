#include <algorithm>
#include <cmath>
#include <random>
#include <unordered_map>

#include "lab/visibility/study_parts.h"
#include "visibility/reference.h"

namespace photohull::visibility {
namespace {

using glm::dvec2;
using glm::dvec4;
using glm::ivec2;

constexpr int kTexels = 250;

/// Triangles whose bounds on the map touch the texels.
class Candidates {
 public:
  Candidates(const MapLayout& layout, const TriMesh& mesh, const std::vector<ivec2>& texels)
      : width_(layout.size.x) {
    for (const ivec2& t : texels) of_[key(t)];
    const PartLayout& part = layout.parts[0];
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      dvec2 low(1e300), high(-1e300);
      for (const std::uint32_t vertex : mesh.triangles[i]) {
        const dvec4 h(mesh.positions[vertex], 1);
        const dvec2 at =
            dvec2(glm::dot(part.row_x, h), glm::dot(part.row_y, h)) / glm::dot(part.row_w, h);
        low = glm::min(low, at), high = glm::max(high, at);
      }
      add(i, low, high, texels);
    }
  }
  const std::vector<std::uint32_t>& at(const ivec2& texel) const { return of_.at(key(texel)); }

 private:
  std::int64_t key(const ivec2& t) const { return std::int64_t(t.y) * width_ + t.x; }

  void add(std::uint32_t triangle, const dvec2& low, const dvec2& high,
           const std::vector<ivec2>& texels) {
    const ivec2 first(glm::floor(low)), last(glm::floor(high));
    const std::int64_t count =
        std::int64_t(last.x - first.x + 1) * std::int64_t(last.y - first.y + 1);
    if (count > std::int64_t(texels.size())) {
      for (const ivec2& t : texels)
        if (t.x >= first.x && t.x <= last.x && t.y >= first.y && t.y <= last.y)
          of_[key(t)].push_back(triangle);
      return;
    }
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) {
        const auto found = x >= 0 && x < width_ ? of_.find(key({x, y})) : of_.end();
        if (found != of_.end()) found->second.push_back(triangle);
      }
  }

  int width_;
  std::unordered_map<std::int64_t, std::vector<std::uint32_t>> of_;
};

TriMesh part_of(const TriMesh& mesh, const std::vector<std::uint32_t>& triangles) {
  TriMesh out;
  out.origin = mesh.origin;
  for (const std::uint32_t i : triangles) {
    const auto first = std::uint32_t(out.positions.size());
    for (const std::uint32_t vertex : mesh.triangles[i])
      out.positions.push_back(mesh.positions[vertex]);
    out.triangles.push_back({first, first + 1, first + 2});
  }
  return out;
}

}  // namespace

std::vector<DetectionCell> detect_triangles(gpu::Context& context, const StudyScene& scene,
                                            const Geometry& geometry, int resolution,
                                            unsigned seed) {
  std::vector<ivec2> texels;
  std::vector<std::vector<std::uint32_t>> seen;
  std::vector<DetectionCell> out;
  for (const char* name : {"sub-pixel", "coverage", "lists"}) {
    Technique technique = parse_technique("technique", name);
    technique.resolution = resolution;
    const VisibilityMap map = render_map(context, scene.viewpoint, geometry, technique);
    if (texels.empty()) {
      std::mt19937_64 random(seed);
      for (int tries = 0; int(texels.size()) < kTexels && tries < 100 * kTexels; ++tries) {
        const int row = int(random() % std::uint64_t(resolution));
        const ivec2 t(int(random() % std::uint64_t(resolution)), row);
        if (!map.triangles_at(context, 0, t).empty()) texels.push_back(t);
      }
      const Candidates candidates(map.layout(), scene.mesh, texels);
      Technique exact = parse_technique("technique", "lists");
      for (const ivec2& t : texels) {
        const auto& possible = candidates.at(t);
        const reference::Map reference(map.layout(), exact, part_of(scene.mesh, possible));
        seen.emplace_back();
        for (const std::uint32_t i : reference.seen_in(0, t)) seen.back().push_back(possible[i]);
      }
    }
    std::size_t total = 0, found = 0;
    for (std::size_t i = 0; i < texels.size(); ++i) {
      const auto known = map.triangles_at(context, 0, texels[i]);
      total += seen[i].size();
      for (const std::uint32_t triangle : seen[i])
        found += std::binary_search(known.begin(), known.end(), triangle);
    }
    out.push_back({scene.name, name, resolution,
                   double(total) / double(std::max<std::size_t>(texels.size(), 1)),
                   100.0 * double(found) / double(std::max<std::size_t>(total, 1))});
  }
  return out;
}

}  // namespace photohull::visibility

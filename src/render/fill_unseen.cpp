#include <vector>

#include "render/bake_colour.h"

namespace photohull::render {
namespace {

constexpr int kMaxRings = 1024;  // bounds the work on long tunnels that nobody sees into
constexpr glm::vec3 kNobodySees{0.5f};

glm::vec3 mean_seen(const TriMesh& mesh) {
  glm::dvec3 sum(0);
  std::size_t count = 0;
  for (std::size_t i = 0; i < mesh.colours.size(); ++i) {
    if (mesh.confidence[i] <= 0) continue;
    sum += glm::dvec3(mesh.colours[i]);
    ++count;
  }
  return count ? glm::vec3(sum / double(count)) : kNobodySees;
}

}  // namespace

void fill_unseen(TriMesh& mesh) {
  std::vector<std::uint8_t> known(mesh.colours.size());
  for (std::size_t i = 0; i < known.size(); ++i) known[i] = mesh.confidence[i] > 0;
  const auto whole = [&](std::uint32_t t) {
    const auto& corners = mesh.triangles[t];
    return known[corners[0]] && known[corners[1]] && known[corners[2]];
  };
  std::vector<std::uint32_t> open;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    if (!whole(t)) open.push_back(t);
  std::vector<glm::vec4> sums(open.empty() ? 0 : mesh.colours.size(), glm::vec4(0));
  std::vector<std::uint32_t> ring;
  for (int round = 0; round < kMaxRings && !open.empty(); ++round) {
    ring.clear();
    for (const std::uint32_t t : open)
      for (const std::uint32_t to : mesh.triangles[t]) {
        if (known[to]) continue;
        for (const std::uint32_t from : mesh.triangles[t]) {
          if (!known[from]) continue;
          if (sums[to].w == 0) ring.push_back(to);
          sums[to] += glm::vec4(mesh.colours[from], 1);
        }
      }
    if (ring.empty()) break;
    for (const std::uint32_t v : ring) {
      mesh.colours[v] = glm::vec3(sums[v]) / sums[v].w;
      known[v] = 1;
    }
    std::erase_if(open, whole);
  }
  const glm::vec3 rest = mean_seen(mesh);
  for (std::size_t i = 0; i < known.size(); ++i)
    if (!known[i]) mesh.colours[i] = rest;
}

}  // namespace photohull::render

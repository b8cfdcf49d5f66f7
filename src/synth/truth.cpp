#include "synth/truth.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "synth/random.h"

namespace photohull::synth {
namespace {

bool in_frame(const LensCamera& lens, const glm::dvec3& world) {
  const auto pixel = lens.project(world);
  if (!pixel || !lens.camera.on_image(*pixel)) return false;
  if (lens.distortion.model == DistortionModel::kNone) return true;
  // Far outside its frame the model of a lens may fold points back in.
  const auto back = lens.undistorted(*pixel);
  const glm::dvec3 p = lens.camera.to_camera(world);
  return back && length(*back - glm::dvec2(p) / p.z) < 1e-6;
}

}  // namespace

std::vector<TruthSample> sample_surface(const Surface& surface, int count, std::uint64_t seed) {
  const TriMesh& mesh = surface.mesh;
  std::vector<double> area;
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::dvec3 p(mesh.positions[a]);
    sum +=
        0.5 * length(cross(glm::dvec3(mesh.positions[b]) - p, glm::dvec3(mesh.positions[c]) - p));
    area.push_back(sum);
  }
  std::vector<TruthSample> samples(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    Random random(seed, 0x5a3b1e, std::uint64_t(i));
    const double at = (i + random.uniform()) / count * sum;
    const auto found = std::upper_bound(area.begin(), area.end(), at) - area.begin();
    const auto triangle = std::min(std::size_t(found), area.size() - 1);
    const double s = std::sqrt(random.uniform()), v = random.uniform();
    const auto& [a, b, c] = mesh.triangles[triangle];
    samples[std::size_t(i)] = {
        (1 - s) * mesh.world(a) + s * (1 - v) * mesh.world(b) + s * v * mesh.world(c),
        surface.face_normals[triangle], 0};
  }
  return samples;
}

void count_views(const Surface& surface, const std::vector<LensCamera>& cameras,
                 std::vector<TruthSample>& samples, const std::function<void(double)>& part_done) {
  constexpr std::size_t kBlock = 512;
  const std::size_t blocks = (samples.size() + kBlock - 1) / kBlock;
  std::atomic<std::size_t> done = 0;
  tbb::parallel_for(std::size_t(0), blocks, [&](std::size_t block) {
    const std::size_t first = block * kBlock, last = std::min(first + kBlock, samples.size());
    std::vector<Ray> rays;
    std::vector<std::size_t> owners;
    for (const LensCamera& lens : cameras) {
      const glm::dvec3 eye = lens.camera.center();
      rays.clear(), owners.clear();
      for (std::size_t i = first; i < last; ++i) {
        const glm::dvec3 normal(samples[i].normal);
        if (dot(normal, eye - samples[i].position) <= 0) continue;
        if (!in_frame(lens, samples[i].position)) continue;
        const glm::dvec3 origin = samples[i].position + 1e-5 * surface.diagonal * normal;
        rays.push_back({origin, eye - origin, 0, 1});
        owners.push_back(i);
      }
      std::vector<std::uint8_t> blocked(rays.size());
      surface.rays->occluded(rays, blocked);
      for (std::size_t i = 0; i < rays.size(); ++i)
        samples[owners[i]].views = std::uint16_t(samples[owners[i]].views + !blocked[i]);
    }
    part_done(double(++done) / double(blocks));
  });
}

}  // namespace photohull::synth

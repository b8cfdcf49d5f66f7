#include "pipeline/check_room.h"

#include <algorithm>

#include "carving/fit_grid.h"
#include "pipeline/checks.h"
#include "pipeline/estimate.h"
#include "pipeline/larger_photographs.h"
#include "pipeline/read_scene.h"
#include "pipeline/texture_stage.h"
#include "projtex/gpu_views.h"
#include "volume/extract_mesh.h"

namespace photohull::pipeline {
namespace {

constexpr int kProbeVoxels =
    128;                    // along the box, of the hull that tells how much surface there is
constexpr int kPlenty = 4;  // times what is usual: no object has so much surface

CostQuestion question_of(const ReconstructOptions& options, const Box& box, const GridSpec& grid,
                         std::span<const Camera> cameras, Silhouettes masks) {
  CostQuestion question;
  question.cameras.assign(cameras.begin(), cameras.end());
  question.grid = grid;
  question.method = options.effective_method();
  question.masks = masks;
  if (options.part) question.part = {0, options.part_bricks};
  if (makes_texture(options)) {
    question.texture_bytes = texture_bytes(memory_limit(options));
    question.pixel = carving::pixel_footprint(box, question.cameras);
  }
  return question;
}

MemoryNeed need_of(CostQuestion question) {
  MemoryNeed need{estimate_cost(question).bytes, 0, question.grid->voxel_size};
  question.grid.reset();
  need.fixed = estimate_cost(question).bytes;
  return need;
}

/// Squares of the lattice's voxels.
double area_of(const Subject& subject, Hull& hull) {
  const double voxel =
      std::max(carving::voxel_size_for(subject.box, kProbeVoxels), subject.grid.voxel_size);
  const TriMesh mesh =
      extract_mesh(hull.carve_box(carving::fit_grid(subject.box, voxel), subject.box));
  double twice = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    twice += double(glm::length(
        glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a])));
  return 0.5 * twice / (subject.grid.voxel_size * subject.grid.voxel_size);
}

}  // namespace

void check_room(const ReconstructOptions& options, const Box& box, const GridSpec& grid,
                std::span<const Camera> cameras) {
  check_memory(need_of(question_of(options, box, grid, cameras, Silhouettes::kNone)),
               memory_limit(options));
}

std::int64_t check_room(const ReconstructOptions& options, const Subject& subject, Hull& hull) {
  if (!any_mask(subject.views)) return subject.held_bytes;
  CostQuestion question = question_of(options, subject.box, subject.grid,
                                      projtex::cameras_of(subject.views), Silhouettes::kGiven);
  const std::int64_t limit = memory_limit(options);
  const bool holds_some = subject.held_bytes > 0;
  if (!holds_some && kPlenty * estimate_cost(question).bytes <= limit) return 0;
  if (!options.part) question.hull_area = area_of(subject, hull);
  MemoryNeed need = need_of(question);
  const std::int64_t left = limit - need.bytes;
  const std::int64_t fewest = holds_some ? fewest_held_bytes(subject.views) : 0;
  need.bytes += fewest;
  need.fixed += fewest;
  check_memory(need, limit);
  return holds_some ? left : 0;
}

}  // namespace photohull::pipeline

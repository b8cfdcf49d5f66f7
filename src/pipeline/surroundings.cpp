#include "pipeline/surroundings.h"

#include "carving/fit_grid.h"
#include "core/error.h"
#include "core/option_word.h"
#include "mesh/join_meshes.h"
#include "mesh/remove_islands.h"
#include "mesh/remove_unseen.h"
#include "projtex/gpu_views.h"
#include "render/bake_colour.h"
#include "volume/components.h"
#include "volume/extract_mesh.h"

namespace photohull::pipeline {
namespace {

constexpr double kCoarseness = 4;  // voxels of a shell, in those of what it is around
constexpr double kGrowth = 4;      // of a box of whose surroundings nothing is known
constexpr double kLeastGrowth = 1.5, kMostGrowth = 8;  // of the first shell
constexpr std::size_t kMostShells = 3;
constexpr double kNearestAngle = 1.5;     // degrees between views that are matched: far things
constexpr double kCovered = 2;            // voxels of a shell, from what is known better
constexpr double kDebrisFraction = 5e-4;  // of the largest part's voxels
constexpr double kMoreLikelyRight = 0.5;  // confidence is the chance to be right

Box scaled(const Box& box, double factor) {
  const glm::dvec3 half = 0.5 * factor * box.size();
  return {box.center() - half, box.center() + half};
}

Box around_both(const Box& a, const Box& b) {
  return {glm::min(a.min, b.min), glm::max(a.max, b.max)};
}

bool holds(const Box& a, const Box& b) { return a.contains(b.min) && a.contains(b.max); }

/// Colours and confidence; returns how many views see each vertex. Confidence is the chance to lie
/// within a voxel, and was fitted where voxels are about a pixel large: directions that lie closer
/// together tell as much of larger ones.
std::vector<float> colour(const SurfaceJob& job, const GridSpec& grid, TriMesh& mesh) {
  const std::vector<Camera> cameras = projtex::cameras_of(job.subject.views);
  std::vector<render::PooledEvidence> evidence =
      bake_colour(job.context, grid, {*job.images, cameras, job.subject.noise_sigma},
                  render::Shaping::kPhotographs, mesh, job.progress)
          .evidence;
  std::vector<float> views;
  for (std::size_t i = 0; i < evidence.size(); ++i) {
    evidence[i].scatter *= float(kCoarseness * kCoarseness);
    mesh.confidence[i] = float(render::confidence_of(evidence[i], render::Shaping::kPhotographs));
    views.push_back(evidence[i].views);
  }
  return views;
}

/// The surface in one shell, without what `known` has.
TriMesh surface_in(const SurfaceJob& job, const Shell& shell, const TriMesh& known, bool open,
                   std::int64_t& samples) {
  SparseVolume volume =
      method_of(job.options).carve_around(job, {shell.grid, shell.box, kNearestAngle}, samples);
  remove_small_components(volume, kDebrisFraction);
  TriMesh mesh = extract_mesh(volume);
  volume = {};
  if (mesh.triangles.empty()) return mesh;
  std::vector<float> views = colour(job, shell.grid, mesh);
  if (open) mesh = remove_unseen(mesh, kMoreLikelyRight, {&views});
  leave_out_covered(known, kCovered * shell.grid.voxel_size, mesh, {&views});
  if (open) remove_islands(mesh, views, {.voxel_size = shell.grid.voxel_size});
  return mesh;
}

double area(const TriMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += 0.5 * double(glm::length(glm::cross(mesh.positions[b] - mesh.positions[a],
                                               mesh.positions[c] - mesh.positions[a])));
  return sum;
}

}  // namespace

std::vector<Shell> plan_shells(const Box& box, double voxel_size, const std::optional<Box>& seen) {
  PHOTOHULL_CHECK_OP(voxel_size, >, 0.0);
  const Box wanted = seen ? around_both(*seen, scaled(box, kLeastGrowth)) : scaled(box, kGrowth);
  std::vector<Shell> shells;
  double growth = kMostGrowth, coarseness = kCoarseness;
  do {
    const Box most = scaled(box, growth);
    const Box shell{glm::max(wanted.min, most.min), glm::min(wanted.max, most.max)};
    shells.push_back({shell, carving::fit_grid(shell, coarseness * voxel_size)});
    growth *= kCoarseness, coarseness *= kCoarseness;
  } while (shells.size() < kMostShells && !holds(shells.back().box, wanted));
  return shells;
}

Around make_surroundings(const SurfaceJob& job, const TriMesh& mesh, bool open) {
  TriMesh known = mesh;
  Around around;
  for (const Shell& shell :
       plan_shells(job.subject.box, job.subject.grid.voxel_size, job.subject.seen)) {
    const TriMesh part = surface_in(job, shell, known, open, around.samples);
    append_mesh(part, known);
    append_mesh(part, around.mesh);
    around.box = shell.box;
    around.findings.push_back({shell.box, shell.grid.voxel_size, shell.grid.voxels(),
                               std::int64_t(part.triangles.size()), area(part)});
  }
  const double all = area(known);
  for (ShellFindings& shell : around.findings)
    shell.area_share = all > 0 ? shell.area_share / all : 0;
  return around;
}

void warn_of_surroundings(const ReconstructOptions& options, bool bounded, Progress& progress) {
  if (!bounded || options.surroundings != Surroundings::kOn) return;
  progress.warn(concat(option_word("surroundings", "on"),
                       ": silhouettes bound the object, and what surrounds it is in none of "
                       "them; it is left out (",
                       option_word("masks", "none"), " reconstructs without silhouettes)"));
}

}  // namespace photohull::pipeline

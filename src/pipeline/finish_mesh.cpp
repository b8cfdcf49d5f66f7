#include "pipeline/finish_mesh.h"

#include <algorithm>
#include <cmath>

#include "carving/fit_stems.h"
#include "core/error.h"
#include "core/option_word.h"
#include "mesh/remove_islands.h"
#include "mesh/remove_unseen.h"
#include "mesh/simplify_mesh.h"
#include "pipeline/checks.h"
#include "projtex/gpu_views.h"
#include "refine/dust.h"
#include "volume/components.h"
#include "volume/extract_mesh.h"

namespace photohull::pipeline {
namespace {

constexpr double kDebrisFraction = 5e-4;  // of the largest part's voxels
constexpr double kMoreLikelyRight = 0.5;  // confidence is the chance to be right

std::int64_t fit_stems(const SurfaceJob& job, TriMesh& mesh) {
  std::vector<carving::StemView> views;
  for (const PreparedView& view : job.subject.views)
    if (!view.mask.empty()) views.push_back({view.camera, &view.mask, &view.silhouette.lines});
  return std::int64_t(
      carving::fit_stems(views, job.subject.grid.voxel_size, mesh, tuned(job.options).stems));
}

}  // namespace

SeenVertices seen_vertices(const std::vector<render::PooledEvidence>& evidence) {
  SeenVertices seen;
  for (const render::PooledEvidence& e : evidence) {
    seen.views.push_back(e.seeing);
    seen.disagreement.push_back(e.seen ? e.disagreement : NAN);
  }
  return seen;
}

SparseVolume remove_dust(const SurfaceJob& job, SparseVolume volume) {
  const std::vector<Camera> cameras = projtex::cameras_of(job.subject.views);
  const std::vector<carving::Silhouette> silhouettes = silhouettes_of(job.subject.views);
  remove_small_components(volume, kDebrisFraction, [&](auto pieces) {
    std::vector<bool> wanted =
        refine::are_asked_for(job.context, volume, pieces, {cameras, silhouettes, job.beside}, {});
    // What reaches out of a part may be joined with more in another one.
    for (std::size_t i = 0; i < pieces.size() && job.part; ++i)
      wanted[i] = wanted[i] || !std::ranges::all_of(pieces[i], [&](const glm::ivec3& voxel) {
                    return job.part->own.contains(voxel / kBrickEdge);
                  });
    return wanted;
  });
  return volume;
}

ExtractedSurface extract_surface(const SurfaceJob& job, const SparseVolume& volume) {
  ExtractedSurface out{extract_mesh(volume), {}};
  if (const auto sharpen = method_of(job.options).sharpen)
    out.findings.sharpened_vertices = sharpen(job, out.mesh);
  out.findings.stem_vertices = fit_stems(job, out.mesh);
  job.context.release_deleted();  // stages to come need large pieces, and this one left small ones
  return out;
}

ColouredSurface colour_surface(const SurfaceJob& job, TriMesh mesh) {
  if (mesh.triangles.empty() && job.part) return {std::move(mesh), {}, {}};
  if (mesh.triangles.empty())
    throw Error(concat("the volume holds no surface: every part is thinner than a voxel; raise ",
                       option_word("resolution")));
  const std::vector<Camera> cameras = projtex::cameras_of(job.subject.views);
  const render::Shaping shaping = method_of(job.options).by_silhouettes
                                      ? render::Shaping::kSilhouettes
                                      : render::Shaping::kPhotographs;
  BakeReport baked = bake_colour(job.context, job.subject.grid,
                                 {*job.images, cameras, job.subject.noise_sigma, job.beside},
                                 shaping, mesh, job.progress);
  const auto unseen = std::count(mesh.confidence.begin(), mesh.confidence.end(), 0.0f);
  const double share = double(unseen) / double(mesh.confidence.size());
  if (share > 0.5 && !job.part)  // the whole has said so
    job.progress.warn(concat(std::lround(100 * share),
                             " % of the surface is seen by no camera: it is the hull's guess"));
  return {std::move(mesh), std::move(baked.evidence), {share}};
}

bool leaves_open(const ReconstructOptions& options, bool bounded) {
  if (options.unseen != Unseen::kAuto) return options.unseen == Unseen::kOpen;
  return !bounded && method_of(options).needs_no_silhouettes;
}

OpenSurface open_unseen(const SurfaceJob& job, const TriMesh& mesh, SeenVertices seen) {
  const Subject& subject = job.subject;
  const bool by_photographs = !job.bounded;
  IslandFindings islands;
  TriMesh open =
      remove_unseen(mesh, by_photographs ? kMoreLikelyRight : 0, {&seen.views, &seen.disagreement});
  if (by_photographs) {
    const RemovedIslands gone =
        remove_islands(open, seen.views, {.voxel_size = subject.grid.voxel_size},
                       {&seen.views, &seen.disagreement});
    islands = {std::int64_t(gone.pieces), gone.area_share};
  }
  if (open.triangles.empty() && !job.part)
    throw Error(concat(
        "no surface was found that a camera sees and that is more likely right than wrong; check "
        "the cameras (photohull info), or look at all of it with ",
        option_word("unseen", "closed"),
        sentence_about_cameras(subject.box, subject.box_source, sources_of(subject.views))));
  return {std::move(open), std::move(seen), islands};
}

SimplifiedSurface simplify(const SurfaceJob& job, const TriMesh& mesh) {
  const double voxel = job.subject.grid.voxel_size;
  const MeshError& asked = job.options.mesh_error;
  const double error = asked.value * (asked.world_units ? 1 : voxel);
  TriMesh simple = simplify_mesh(mesh, error);
  job.progress.check_cancelled();
  const MeshDistance d = measure_distance(mesh, simple, mean_edge(mesh));
  return {std::move(simple),
          {error / voxel, d.mean / voxel, d.p95 / voxel, d.p999 / voxel, d.max / voxel}};
}

}  // namespace photohull::pipeline

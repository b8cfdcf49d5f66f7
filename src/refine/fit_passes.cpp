#include "refine/fit_passes.h"

#include <chrono>
#include <cmath>

#include "refine/displacement.h"
#include "refine/fit_patches.h"
#include "refine/hull_prior.h"
#include "refine/kernels/choose_views.h"
#include "refine/seat.h"
#include "refine/surface.h"
#include "refine/tile_tasks.h"
#include "refine/trust.h"
#include "volume/distance_from_mesh.h"
#include "volume/extract_mesh.h"

namespace photohull::refine {
namespace {

// What membrane and fairing are for offsets that were fitted: these know more than peaks do.
constexpr double kFitMembrane = 30, kFitFairing = 3;

/// What fitted peaks tell, whatever their taps' spacing.
std::vector<float> information_of(std::span<const Peak> peaks, std::span<const float> spacings) {
  std::vector<float> out;
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    const float square = spacings[i] * spacings[i];
    out.push_back(peaks[i].weight * square * square);
  }
  return out;
}

/// One pass. What is large goes as soon as it is not needed any more.
class FitPass {
 public:
  /// Fits the patches.
  FitPass(const RefineJob& job, const SettledBricks& settled, const SparseVolume& volume)
      : job_(job),
        options_(job.options),
        grid_(volume.grid),
        mesh_(extract_mesh(volume, settled.coarse(volume.grid))),
        graph_(make_graph(mesh_)),
        positions_(voxel_positions(volume.grid, mesh_)) {
    give_back(mesh_);
    choices_ = choose_views(job.context, grid_, mesh_, job.photographs, options_.match);
    const std::vector<Settled> before = settled.at(grid_, positions_);
    for (std::size_t k = 0; k < choices_.size(); ++k)
      if (is_settled(before[k]) && before[k] != Settled::kFlat) choices_[k].views.clear();
    Matches matches = vertex_textures(job, grid_, mesh_, choices_);
    texture_ = std::move(matches.texture);
    fits_ = fit_in_tiles(job, surfels(), choices_);
    samples_ = matches.samples + samples_of(choices_, options_.fit);
    held_ = held_out(fits_);
  }

  const HeldOut& held() const { return held_; }
  std::int64_t samples() const { return samples_; }

  /// Displacements of the vertices: smooth, near the fitted offsets, and with `seats` such that the
  /// surface touches the silhouettes' outlines.
  std::vector<float> displacements(const SparseVolume& hull, const SparseVolume& volume, bool seats,
                                   FitReport& report) {
    const std::vector<float> spacings =
        tap_spacings(grid_, positions_, job_.matching(grid_).cameras(), choices_, options_.fit);
    std::vector<Peak> peaks = peaks_of(fits_, spacings, options_.fit);
    fits_ = {};
    std::vector<float> trust =
        trust_thickness(volume, positions_, mesh_.normals, options_.peak.thick);
    std::vector<float> information;  // of seating alone
    if (seats) information = information_around(graph_, information_of(peaks, spacings));
    std::vector<float> tight_at;
    for (const float t : trust) tight_at.push_back(t * t);
    trust_outlines(grid_, positions_, choices_, job_.cones, options_.fit, trust);
    choices_ = {};
    // What patches cannot be trusted with stays where it is.
    for (std::size_t k = 0; k < peaks.size(); ++k) peaks[k].offset *= trust[k];
    double tight = 0;
    if (job_.is_bounded()) {
      report.hull_trust =
          pull_to_hull(hull, graph_, positions_, {texture_, trust}, options_.hull_prior, peaks);
      tight = options_.hull_prior.trust.value_or(report.hull_trust->front());
    }
    for (float& t : tight_at) t *= float(tight);
    RegularizeOptions smooth = options_.regularize;
    smooth.membrane = kFitMembrane, smooth.fairing = kFitFairing;
    std::vector<float> moves = regularize(graph_, peaks, positions_, mesh_.normals, trust, smooth);
    if (seats)
      seat_outlines(hull, job_.cones, surfels(), {information, tight_at}, options_.seat, moves);
    graph_ = {};
    positions_ = {};
    return moves;
  }

  const TriMesh& mesh() const { return mesh_; }

 private:
  MeshSurfels surfels() const { return {grid_, mesh_, graph_, positions_}; }

  const RefineJob& job_;
  const RefineOptions& options_;
  GridSpec grid_;
  TriMesh mesh_;
  VertexGraph graph_;
  std::vector<glm::vec3> positions_;  // of the vertices, voxels
  std::vector<ViewChoice> choices_;
  std::vector<float> texture_;
  std::vector<PatchFit> fits_;
  std::int64_t samples_ = 0;
  HeldOut held_;
};

}  // namespace

std::int64_t fit_passes(const RefineJob& job, const SettledBricks& settled, BoundingHull& bounding,
                        SparseVolume& volume, std::vector<FitReport>& reports, Progress& progress) {
  const int passes = job.options.fit_passes;
  std::int64_t samples = 0;
  SparseVolume before;
  double best = -1;
  for (int i = 0; i < passes; ++i) {
    const bool last = i + 1 == passes;
    progress.check_cancelled();
    const auto start = std::chrono::steady_clock::now();
    FitReport report;
    {
      FitPass pass(job, settled, volume);
      samples += pass.samples();
      const HeldOut held = pass.held();
      const bool better = held.before > best;
      if (best >= 0) reports.back().kept = better;
      if (!better) {  // on to the last pass, from the surface before
        volume = before;
        best = -1;
        i = passes - 2;
        continue;
      }
      best = held.before;
      const std::vector<float> moves =
          pass.displacements(bounding.volume(), volume, last && job.cones.any(), report);
      if (!last) before = volume;
      move_surface(volume, pass.mesh(), moves);
      for (const float move : moves) report.mean_move += std::abs(move) / double(moves.size());
      report.held_before = held.before, report.held_after = held.after;
    }
    // Not measured anew: steps are short, and passing through the mesh costs more than they gain.
    volume = bounded(job, volume, bounding);
    report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    report.kept = last;
    reports.push_back(report);
  }
  return samples;
}

}  // namespace photohull::refine

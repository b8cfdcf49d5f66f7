// From the hull inwards [Furukawa09], coarse to fine, with the projection onto tangent planes that
// [Montenegro03] proposes as the next step.
#include "refine/refine.h"

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "carving/fit_grid.h"
#include "core/error.h"
#include "core/option_word.h"
#include "refine/bounding_hull.h"
#include "refine/checkpoint.h"
#include "refine/fit_passes.h"
#include "refine/follow.h"
#include "refine/job.h"
#include "refine/matching_step.h"
#include "refine/settle.h"
#include "refine/start_level.h"
#include "refine/surface.h"
#include "volume/distance_from_mesh.h"
#include "volume/extract_mesh.h"

namespace photohull::refine {
namespace {

constexpr double kLeastPixels = 3;  // that a voxel of the first level is wide, without silhouettes
constexpr double kNearReach = kStillReach;  // voxels of exact distance that a step needs
constexpr double kAnglePerSpacing = 2.0;  // reach of a view's partners, in spacings of the cameras
constexpr double kSparseAngle = 75;       // degrees, to which the farthest partners' is widened
constexpr int kMiddleIterations = 2;      // of matching and moving, at the levels between
constexpr double kFullReach = SparseVolume::kBand;

/// Angles to the reference view that the cameras' spacing asks for: where neighbours stand far
/// apart, views at the usual angles would be too few.
MatchOptions fit_angles(std::span<const Camera> cameras, const glm::dvec3& middle,
                        MatchOptions options) {
  std::vector<double> nearest;
  for (const Camera& camera : cameras) {
    const glm::dvec3 ray = glm::normalize(camera.center() - middle);
    double largest = -1;  // cosine
    for (const Camera& other : cameras)
      if (&other != &camera)
        largest = std::max(largest, glm::dot(ray, glm::normalize(other.center() - middle)));
    nearest.push_back(glm::degrees(std::acos(std::clamp(largest, -1.0, 1.0))));
  }
  std::nth_element(nearest.begin(), nearest.begin() + long(nearest.size() / 2), nearest.end());
  const double wanted = kAnglePerSpacing * nearest[nearest.size() / 2];
  options.farthest_angle = std::max(options.farthest_angle, std::min(wanted, kSparseAngle));
  return options;
}

/// A disk that is full must not end a job that may still write its results elsewhere.
void keep(const CheckpointFile& file, const Checkpoint& checkpoint, Progress& progress) {
  try {
    write_checkpoint(file, checkpoint);
  } catch (const Error& problem) {
    progress.warn(concat("an interrupted run could not go on from here: ", problem.what()));
  }
}

class SurfaceRefiner {
 public:
  /// `before`: what the first of the grids starts from; null: from a guess.
  /// Of a part, what is below the images' sampling was told by the whole.
  SurfaceRefiner(RefineJob job, std::vector<GridSpec> grids, const SparseVolume* before,
                 Progress& progress)
      : job_(job), grids_(std::move(grids)), before_(before), progress_(progress) {
    if (job_.is_part)
      settled_ = settled_below_pixels(*before_, job_.finest_cameras(), job_.options.settle);
  }

  SparseVolume run(const CheckpointFile* checkpoint, RefineReport& report) {
    if (checkpoint) resume(*checkpoint, report);
    for (std::size_t level = report.levels.size(); level < grids_.size(); ++level) {
      if (level > 0) job_.options.hull_prior.coarser = report.levels.back().hull_trust;
      report.levels.push_back(refine_level(level, report.fits));
      if (checkpoint && !is_last(level))
        keep(*checkpoint, {volume_, settled_, report.levels}, progress_);
    }
    return std::move(volume_);
  }

 private:
  bool is_last(std::size_t level) const { return level + 1 == grids_.size(); }
  /// Does the level start from a guess?
  bool is_guessed(std::size_t level) const { return level == 0 && !before_; }

  /// Takes over the levels that an interrupted run of the same job had done.
  void resume(const CheckpointFile& checkpoint, RefineReport& report) {
    if (auto done = read_checkpoint(checkpoint, grids_, progress_)) {
      volume_ = std::move(done->volume);
      settled_ = std::move(done->settled);
      report.levels = std::move(done->levels);
    }
    report.resumed = int(report.levels.size());
    if (report.resumed > 0)
      progress_.note(concat("an interrupted run of this job had done ", report.resumed, " of ",
                            grids_.size(), " levels of the refinement: going on from there (",
                            option_word("fresh"), " starts anew)"));
  }

  LevelReport refine_level(std::size_t level, std::vector<FitReport>& fits) {
    const auto start = std::chrono::steady_clock::now();
    LevelReport counts;
    counts.voxel_size = grids_[level].voxel_size;
    if (job_.shared) job_.shared->begin_level(int(level));
    BoundingHull bounding(job_.hull_at(grids_[level]));
    begin(level, bounding.volume(), counts);
    // From here on the hull of space that nothing bounds is only what the surface may meet.
    if (!job_.cones.any()) bounding.drop_far_from(volume_);
    malloc_trim(0);
    const StepFindings findings = match(level, bounding, counts);
    if (is_last(level)) finish(bounding, findings.proof, counts, fits);
    settled_ = findings.settled;
    counts.split = settled_.count(Settled::kSplit);
    counts.settled_pixels = settled_.count(Settled::kPixels);
    counts.settled_plain = settled_.count(Settled::kPlain);
    counts.settled_flat = settled_.count(Settled::kFlat);
    counts.bricks = std::int64_t(volume_.bricks.size());
    counts.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return counts;
  }

  /// The volume that a level starts from: the one before on finer voxels, or a guess.
  void begin(std::size_t level, const SparseVolume& hull, LevelReport& counts) {
    const SparseVolume& from = level == 0 && before_ ? *before_ : volume_;
    volume_ =
        is_guessed(level)
            ? first_guess(job_, hull)
            : bounded(distance_from_mesh(extract_mesh(from), from, hull.grid, kNearReach), hull);
    restore_lost(job_, hull, volume_, counts);
    if (!is_guessed(level) && job_.options.voting)
      revise_by_votes(job_, hull, is_last(level), volume_, counts);
  }

  /// Steps of matching and moving, each followed by distances that are measured anew.
  StepFindings match(std::size_t level, BoundingHull& bounding, LevelReport& counts) {
    const SparseVolume& hull = bounding.volume();
    const RefineOptions& options = job_.options;
    const int iterations = is_last(level)      ? options.fine_iterations
                           : is_guessed(level) ? options.coarse_iterations
                                               : kMiddleIterations;
    StepFindings findings;
    for (int i = 0; i < iterations; ++i) {
      progress_.check_cancelled();
      const bool is_final = is_last(level) && i + 1 == iterations;
      const NearDistances before(volume_);
      findings =
          matching_step(job_, settled_, hull, {is_guessed(level), is_final}, volume_, counts);
      measure_anew(before, bounding, is_final ? kFullReach : kNearReach);
      keep_thin(job_, hull, volume_, counts);
      if (is_final) restore_lost(job_, hull, volume_, counts);
      progress_.update((double(level) + double(i + 1) / iterations) / double(grids_.size()));
    }
    return findings;
  }

  void measure_anew(const NearDistances& before, BoundingHull& bounding, double reach) {
    TriMesh mesh = extract_mesh(volume_);
    give_back(mesh);
    SparseVolume after = distance_from_mesh(mesh, volume_, bounding.volume().grid, reach);
    mesh = {};
    keep_still(before, volume_, after);
    volume_ = {};
    volume_ = bounded(job_, after, bounding);
  }

  /// What follows the last step of the last level.
  void finish(BoundingHull& bounding, const Proof& proof, LevelReport& counts,
              std::vector<FitReport>& fits) {
    counts.samples += fit_passes(job_, settled_, bounding, volume_, fits, progress_);
    const SparseVolume& hull = bounding.volume();
    if (job_.is_bounded())
      counts.restored += std::int64_t(fill_unproven(hull, proof.positions, proof.normals,
                                                    proof.weights, job_.options.unproven, volume_));
    keep_thin(job_, hull, volume_, counts);
    if (job_.cones.any())
      counts.restored += std::int64_t(rejoin_stems(hull, job_.cones.cameras, job_.cones.silhouettes,
                                                   job_.options.thin, volume_));
  }

  RefineJob job_;
  std::vector<GridSpec> grids_;  // coarse to fine
  const SparseVolume* before_;
  Progress& progress_;
  SparseVolume volume_;
  SettledBricks settled_;  // by the level before
};

/// Grids from the coarsest on, each with voxels half as large as the one before.
std::vector<GridSpec> grids_to(const GridSpec& finest, std::span<const Camera> cameras,
                               bool is_bounded, int levels) {
  std::vector<GridSpec> grids{finest};
  const auto longest = [](const GridSpec& grid) {
    const glm::ivec3 n = grid.voxels();
    return std::max({n.x, n.y, n.z});
  };
  // The votes' patches reach as far as voxels: where these hardly hold pixels, they hold nothing.
  const double least =
      is_bounded ? 0 : kLeastPixels * carving::pixel_footprint(finest.bounds(), cameras);
  const auto is_fine = [&](const GridSpec& grid) {
    return longest(grid) > RefineOptions::kCoarsestVoxels ||
           (grid.voxel_size < least && longest(grid) > RefineOptions::kFewestVoxels);
  };
  while (levels > 0 ? int(grids.size()) < levels : is_fine(grids.front()))
    grids.insert(grids.begin(), carving::coarser(grids.front()));
  return grids;
}

}  // namespace

std::optional<HullTrust> RefineReport::hull_trust() const {
  std::optional<HullTrust> last;
  for (const LevelReport& level : levels)
    if (level.hull_trust) last = level.hull_trust;
  for (const FitReport& fit : fits)
    if (fit.hull_trust) last = fit.hull_trust;
  return last;
}

SparseVolume refine_surface(gpu::Context& context, const RefineScene& scene,
                            const RefineOptions& options, Progress& progress, RefineReport* report,
                            const CheckpointFile* checkpoint) {
  options.validate();
  PHOTOHULL_CHECK_OP(int(scene.cameras.size()), ==, scene.images.layers());
  PHOTOHULL_CHECK_OP(scene.silhouettes.size(), ==, scene.cameras.size());
  const std::span<const DepthMap> beside =
      scene.whole ? scene.whole->beside : std::span<const DepthMap>();
  RefineJob job{context,
                scene.hull_at,
                {scene.cameras, scene.silhouettes, beside},
                {scene.images, scene.cameras, options.noise_sigma, beside},
                options,
                scene.finest.voxel_size,
                scene.larger,
                scene.shared,
                scene.whole != nullptr};
  const GridSpec& whole = scene.whole ? scene.whole->volume.grid : scene.finest;
  job.options.match = fit_angles(scene.cameras, whole.bounds().center(), options.match);
  if (scene.whole) {
    job.options.fit.first_voxel = scene.whole->first_voxel;
    job.options.hull_prior.trust = scene.whole->hull_trust;
  }
  std::vector<GridSpec> grids = grids_to(scene.finest, scene.cameras, job.is_bounded(),
                                         scene.whole ? scene.whole->levels : options.levels);
  RefineReport counts;
  const SparseVolume* before = scene.whole ? &scene.whole->volume : nullptr;
  if (!before && scene.before && job.is_bounded()) {
    const auto from = [&](int levels) {
      return grids.end() - std::min(std::ptrdiff_t(grids.size()), std::ptrdiff_t(levels));
    };
    const SparseVolume hull = scene.hull_at(*from(options.follow.levels));
    if (const int levels = levels_from(*scene.before, hull, options.follow); levels > 0) {
      before = &scene.before->surface;
      grids.erase(grids.begin(), from(levels));
    }
  }
  counts.followed = before != nullptr;
  SparseVolume volume =
      SurfaceRefiner(job, std::move(grids), before, progress).run(checkpoint, counts);
  if (report) *report = std::move(counts);
  return volume;
}

}  // namespace photohull::refine

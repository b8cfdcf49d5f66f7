// Which options make sense.
#include <cmath>

#include "core/error.h"
#include "core/grid.h"
#include "refine/refine.h"

namespace photohull::refine {
namespace {

void require(bool ok, const char* what) {
  if (!ok) throw UsageError(what);
}

bool is_share(double value) { return value > 0 && value <= 1; }
bool is_score(double value) { return value >= -1 && value <= 1; }
bool is_cosine(double value) { return value >= 0 && value < 1; }
bool is_length(double value) { return value >= 0 && value <= 1000; }

void check(const LabelOptions& o) {
  require(o.evidence > 0 && o.evidence <= 1000, "label.evidence must lie in (0, 1000]");
  require(o.unknown >= 0 && o.unknown <= 1000, "label.unknown must lie in [0, 1000]");
  require(o.iterations >= 0 && o.iterations <= 10000, "label.iterations must lie in [0, 10000]");
}

void check(const VoteOptions& o) {
  require(o.ray_spacing > 0 && is_length(o.ray_spacing), "vote.ray_spacing must be positive");
  require(o.again_spacing > 0 && is_length(o.again_spacing), "vote.again_spacing must be positive");
  require(o.last_spacing > 0 && is_length(o.last_spacing), "vote.last_spacing must be positive");
  require(is_score(o.again_score), "vote.again_score must lie in [-1, 1]");
  require(o.tap_spacing > 0 && is_length(o.tap_spacing), "vote.tap_spacing must be positive");
  require(is_share(o.best_pairs), "vote.best_pairs must lie in (0, 1]");
  require(is_score(o.least_score), "vote.least_score must lie in [-1, 1]");
  require(o.distinct_by > 0, "vote.distinct_by must be positive");
  require(o.band > 0 && o.band <= SparseVolume::kBand, "vote.band must lie in (0, 3] voxels");
  require(o.least_weight > 0, "vote.least_weight must be positive");
  require(o.again_weight > 0, "vote.again_weight must be positive");
  require(o.rounds >= 0 && o.rounds <= 20, "vote.rounds must be 0 to 20");
  require(o.tiles >= 1 && o.tiles <= 32, "vote.tiles must be 1 to 32");
  require(o.last_rounds >= 0 && o.last_rounds <= 20, "vote.last_rounds must be 0 to 20");
  require(o.bare_reach >= 0 && o.bare_reach <= OpenVoteOptions::kAnyReach,
          "vote.bare_reach must be 0 to 1048576 rays");
  require(o.freeing_weight > 0, "vote.freeing_weight must be positive");
}

void check(const OpenVoteOptions& o) {
  require(o.reach >= 0 && o.reach <= OpenVoteOptions::kAnyReach,
          "open.reach must be 0 to 1048576 rays");
  require(o.last_reach >= 0 && o.last_reach <= OpenVoteOptions::kAnyReach,
          "open.last_reach must be 0 to 1048576 rays");
}

void check(const CloseOptions& o) {
  require(o.rings >= 0 && o.rings <= 1000, "close.rings must be 0 to 1000");
  require(o.belt >= 0 && o.belt <= o.rings, "close.belt must be 0 to close.rings");
  require(o.iterations >= 0, "close.iterations must not be negative");
  require(o.longest >= 0 && o.longest <= SparseVolume::kBand,
          "close.longest must lie in [0, 3] voxels");
  require(is_length(o.thickness), "close.thickness must lie in [0, 1000] voxels");
}

void check(const LookOptions& o) {
  require(is_score(o.least_score), "look.least_score must lie in [-1, 1]");
  require(o.least_weight >= 0 && o.least_weight <= 1, "look.least_weight must lie in [0, 1]");
  require(is_length(o.margin), "look.margin must lie in [0, 1000] voxels");
  require(o.least_lines >= 1, "look.least_lines must be at least 1");
}

void check(const SeatOptions& o) {
  require(o.passes >= 0 && o.passes <= 100, "seat.passes must be 0 to 100");
  require(o.reach >= 0 && o.reach < SparseVolume::kBand, "seat.reach must lie in [0, 3) voxels");
  require(o.unsure > 0 && is_length(o.unsure), "seat.unsure must lie in (0, 1000] voxels");
  require(o.margin >= 0 && o.margin <= 1, "seat.margin must lie in [0, 1] voxels");
}

void check(const SettleOptions& o) {
  require(is_length(o.least_pixels), "settle.least_pixels must lie in [0, 1000] pixels");
  require(o.least_texture >= 0 && o.least_texture <= 1, "settle.least_texture must lie in [0, 1]");
  require(is_length(o.flat), "settle.flat must lie in [0, 1000] 1 / voxel");
}

void check(const RimOptions& o) {
  require(o.weight >= 0 && o.weight <= 1000, "rims.weight must lie in [0, 1000]");
  require(o.reach > 0 && is_length(o.reach), "rims.reach must lie in (0, 1000] voxels");
  require(o.told > 0 && o.told <= 1000, "rims.told must lie in (0, 1000]");
}

void check(const ThinHullOptions& o) {
  require(o.depth >= 0 && o.depth <= SparseVolume::kBand, "thin.depth must lie in [0, 3] voxels");
  require(o.reach >= 0 && o.reach <= SparseVolume::kBand, "thin.reach must lie in [0, 3] voxels");
}

void check(const UnprovenOptions& o) {
  require(o.least_weight >= 0 && o.least_weight <= 1, "unproven.least_weight must lie in [0, 1]");
  require(o.least_depth >= 0 && o.least_depth <= SparseVolume::kBand,
          "unproven.least_depth must lie in [0, 3] voxels");
}

void check(const MatchOptions& o) {
  require(o.least_spacing > 0 && is_length(o.least_spacing),
          "match.least_spacing must be positive");
  require(is_length(o.pixel_spacing), "match.pixel_spacing must not be negative");
  require(is_length(o.most_bend), "match.most_bend must lie in [0, 1000] 1 / voxel");
  require(is_share(o.best_pairs), "match.best_pairs must lie in (0, 1]");
  require(is_length(o.shift), "match.shift must lie in [0, 1000] voxels");
  require(is_length(o.depth_bias), "match.depth_bias must lie in [0, 1000] voxels");
  require(is_cosine(o.least_cosine), "match.least_cosine must lie in [0, 1)");
  require(is_cosine(o.seen_cosine), "match.seen_cosine must lie in [0, 1)");
  require(o.nearest_angle >= 0 && o.nearest_angle < o.farthest_angle && o.farthest_angle <= 180,
          "match.nearest_angle must lie below match.farthest_angle, both in [0, 180] degrees");
  require(o.sparse_angle >= 0 && o.sparse_angle <= 180,
          "match.sparse_angle must lie in [0, 180] degrees");
  require(o.duplicate_angle >= 0 && o.duplicate_angle <= 180,
          "match.duplicate_angle must lie in [0, 180] degrees");
}

void check(const PeakOptions& o) {
  require(o.least_score < o.sure_score && is_score(o.least_score) && is_score(o.sure_score),
          "peak.least_score must lie below peak.sure_score, both in [-1, 1]");
  require(o.thick > 0 && is_length(o.thick), "peak.thick must lie in (0, 1000] voxels");
  require(o.distinct_by > 0, "peak.distinct_by must be positive");
}

void check(const FitOptions& o) {
  require(o.steps >= 0 && o.steps <= 100, "fit.steps must be 0 to 100");
  require(o.noise >= 0 && o.noise <= 1, "fit.noise must be 0 to 1");
  require(o.hold_out >= 0, "fit.hold_out must not be negative");
  require(o.least_spacing > 0 && is_length(o.least_spacing), "fit.least_spacing must be positive");
  require(is_length(o.pixel_spacing), "fit.pixel_spacing must not be negative");
  require(o.least_score < o.sure_score && is_score(o.least_score) && is_score(o.sure_score),
          "fit.least_score must lie below fit.sure_score, both in [-1, 1]");
  require(o.slope > 0 && is_length(o.slope), "fit.slope must be positive");
  require(o.largest_offset >= 0 && o.largest_offset < SparseVolume::kBand,
          "fit.largest_offset must lie in [0, 3) voxels");
  require(o.largest_step > 0 && is_length(o.largest_step), "fit.largest_step must be positive");
  require(o.most_bend >= 0 && is_length(o.most_bend), "fit.most_bend must not be negative");
  require(is_length(o.sure), "fit.sure must not be negative");
  require(o.most_weight > 0 && is_length(o.most_weight), "fit.most_weight must be positive");
  require(o.membrane >= 0, "fit.membrane must not be negative");
  require(o.fairing >= 0, "fit.fairing must not be negative");
}

void check(const RegularizeOptions& o) {
  require(o.membrane >= 0, "regularize.membrane must not be negative");
  require(o.fairing >= 0, "regularize.fairing must not be negative");
  require(o.robust > 0, "regularize.robust must be positive");
  require(o.reweightings >= 0, "regularize.reweightings must not be negative");
  require(o.iterations >= 1, "regularize.iterations must be at least 1");
}

}  // namespace

void RefineOptions::validate() const {
  require(levels >= 0 && levels <= 8, "levels must be 0 (automatic) to 8");
  require(coarse_iterations >= 1 && middle_iterations >= 1 && fine_iterations >= 1,
          "iterations must be at least 1");
  require(coarse_offsets >= 3 && coarse_offsets <= 64 && fine_offsets >= 3 && fine_offsets <= 64,
          "offsets must be 3 to 64");
  require(step > 0 && step <= 2, "step must lie in (0, 2] voxels");
  require(aggregations >= 0, "aggregations must not be negative");
  require(noise_sigma > 0 && std::isfinite(noise_sigma), "noise_sigma must be positive");
  check(vote);
  check(open);
  check(close);
  check(rims);
  check(thin);
  check(unproven);
  check(label);
  check(look);
  check(seat);
  check(settle);
  require(restore.least_views >= 1, "restore.least_views must be at least 1");
  require(restore.most_before >= 0, "restore.most_before must not be negative");
  check(match);
  require(photometric >= 0 && photometric <= 100, "photometric must be 0 to 100");
  check(fit);
  check(peak);
  check(regularize);
}

}  // namespace photohull::refine

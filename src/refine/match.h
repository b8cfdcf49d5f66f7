// What is known of surface patches by photo-consistency, and what decides it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/describe.h"
#include "photo/noise.h"

namespace photohull::refine {

inline constexpr float kNoScore = -2;   ///< there are too few views to compare
inline constexpr int kPatchRadius = 2;  ///< taps: every other place of 5 x 5 in the tangent plane
inline constexpr int kPatchTaps = 13;

struct MatchOptions {
  double least_spacing = 0.4, pixel_spacing = 1, most_bend = 1, best_pairs = 0.4;
  double shift = 1.5, depth_bias = 2.5, least_cosine = 0.2, seen_cosine = 0.02;
  double nearest_angle = 5, farthest_angle = 70, duplicate_angle = 8;
};

inline void describe(Described& to, MatchOptions& o) {
  to.number("least_spacing", &o.least_spacing, above(0, 1000), "voxels",
            "least distance between a patch's taps");
  to.number("pixel_spacing", &o.pixel_spacing, from_to(0, 1000), "pixels",
            "least distance between a patch's taps in the reference view");
  to.number("most_bend", &o.most_bend, from_to(0, 1000), "1 / voxel",
            "largest curvature that a patch follows");
  to.number("best_pairs", &o.best_pairs, above(0, 1), "",
            "share of the pairs of views that a score is the mean of");
  to.number("shift", &o.shift, from_to(0, 1000), "voxels",
            "how far the receiver is moved along its normal, when it is asked whether a view sees "
            "it");
  to.number("depth_bias", &o.depth_bias, from_to(0, 1000), "voxels",
            "distance behind a depth map at which surface counts as seen all the same");
  to.number("least_cosine", &o.least_cosine, below(0, 1), "",
            "least cosine between a normal and the direction of a camera that is matched");
  to.number(
      "seen_cosine", &o.seen_cosine, below(0, 1), "",
      "cosine between a normal and the direction of a camera above which it sees the surface at "
      "all");
  to.number("nearest_angle", &o.nearest_angle, from_to(0, 180), "degrees",
            "least angle between the reference and a view compared with it");
  to.number("farthest_angle", &o.farthest_angle, from_to(0, 180), "degrees",
            "greatest angle between the reference and a view compared with it");
  to.rule(o.nearest_angle < o.farthest_angle, "nearest_angle", "must lie below", "farthest_angle");
  to.number("duplicate_angle", &o.duplicate_angle, from_to(0, 180), "degrees",
            "angle between views below which they tell nearly the same");
}

/// What raises the variance of patches in their correlation: that of rounding to 8 bits, or the
/// noise's where it is smaller. Not all of the noise's: it would lower scores where photographs are
/// noisy, true and false ones alike, and Matches::texture says what noise leaves.
inline double variance_floor(double noise_sigma) {
  return std::min(noise_sigma * noise_sigma, kRoundingNoise * kRoundingNoise);
}

/// Offsets along the normals, in voxels: first, first + step, ... (count of them).
struct OffsetRange {
  double first = 0, step = 0.5;
  int count = 1;
  double at(double index) const { return first + step * index; }
};

struct Matches {
  OffsetRange range;
  std::vector<float> scores;   ///< vertices x range.count; kNoScore where nothing is known
  std::vector<float> texture;  ///< per vertex, [0, 1]: share of a patch's variance that noise does
                               ///< not explain; 1 where nothing is known
  std::int64_t samples = 0;    ///< texture samples taken

  std::span<const float> of(std::size_t vertex) const {
    return {scores.data() + vertex * std::size_t(range.count), std::size_t(range.count)};
  }
};

}  // namespace photohull::refine

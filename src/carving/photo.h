// Carving by photo-consistency: plane sweeps through what stands [SeitzDyer97; KutulakosSeitz00;
// Montenegro03].
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <variant>

#include "carving/search_disc.h"
#include "carving/statistic.h"
#include "core/describe.h"
#include "core/grid.h"
#include "core/progress.h"
#include "gpu/context.h"
#include "projtex/gpu_views.h"
#include "projtex/image_set.h"
#include "projtex/sample_images.h"
#include "visibility/sweep_test.h"

namespace photohull::carving {

enum class PhotoMethod {
  kVoxelColoring,  ///< one sweep, along the axis that has the most cameras on one side
  kSpaceCarving    ///< sweeps along +-x, +-y, +-z until nothing is left to carve
};

struct PhotoOptions {
  PhotoMethod method = PhotoMethod::kSpaceCarving;
  /// What decides whether cameras agree on a voxel, and who sees it.
  Statistic statistic = Statistic::kZncc;
  visibility::SweepTest visibility = visibility::kDefaultSweepTest;
  double keep_score = 0.7, better_by = 0.2;
  int min_views = 3;
  double noise_sigma = 0.01, min_texture = 1.5;
  int supersample = 1;
  double search_radius = 0;
  bool front_face = false;
  double depth_bias = 2.5;
  int max_path = 64, max_rounds = 4;

  void validate() const;  ///< throws UsageError naming the field
};

inline void describe(Described& to, PhotoOptions& o) {
  to.affects(Stage::kSurface);
  to.number("keep_score", &o.keep_score, Range{0, 1, true, true}, "",
            "score from which a voxel counts as consistent");
  to.number("better_by", &o.better_by, from_to(0, 1), "",
            "lead by which a voxel behind an inconsistent one must correlate for that to go");
  to.number("min_views", &o.min_views, at_least(2), "",
            "cameras that must see a voxel before its consistency means anything");
  to.number("noise_sigma", &o.noise_sigma, above(0), "",
            "standard deviation of the images' noise, square roots of linear light; measured "
            "where it is not given");
  to.number("min_texture", &o.min_texture, at_least(0), "",
            "texture, in standard deviations of the noise, below which it tells nothing");
  to.number("supersample", &o.supersample, from_to(1, projtex::kMaxSupersample), "",
            "n x n samples a voxel on top of the sampler's own");
  to.number("search_radius", &o.search_radius, from_to(0, kMaxSearchRadius), "pixels",
            "distance from a voxel's projection within which each view may show it [Kutulakos00]");
  to.flag("front_face", &o.front_face,
          "reference planes through the voxels' front faces instead of their centres");
  to.number("depth_bias", &o.depth_bias, at_least(0), "voxels",
            "distance behind a depth map at which a voxel counts as seen all the same");
  to.number("max_path", &o.max_path, at_least(1), "layers",
            "depth behind an inconsistent voxel that is searched for a better explanation");
  to.number("max_rounds", &o.max_rounds, at_least(1), "", "rounds of six sweeps, at most");
}

inline void PhotoOptions::validate() const { check_described(*this); }

struct PhotoReport {
  int sweeps = 0;
  int rounds = 0;
  std::int64_t judged = 0;  ///< voxels whose consistency was computed
  std::int64_t carved = 0;
  std::int64_t undecided = 0;   ///< too few cameras, or too little texture: kept
  std::int64_t reverted = 0;    ///< inconsistent, but nothing behind explained the images better
  std::int64_t samples = 0;     ///< texture samples
  double sampling_seconds = 0;  ///< spent in the kernel that takes them
};

/// What is swept through. `images` and `cameras` are in the same order and outlive the object.
struct SweptPhotographs {
  /// Photographs with mip levels, of which each brick takes one; or photographs made for one of the
  /// samplers, in which pixels that show background do not count.
  std::variant<std::reference_wrapper<const projtex::ImageSet>,
               std::reference_wrapper<const projtex::SampleImages>>
      images;
  std::span<const Camera> cameras;
};

/// Carves `hull` and returns the result with a sub-voxel distance where something was carved; what
/// was not touched keeps the hull's distance.
SparseVolume carve_photo(gpu::Context& context, const SparseVolume& hull,
                         const SweptPhotographs& photographs, const PhotoOptions& options,
                         Progress& progress, PhotoReport* report = nullptr);

}  // namespace photohull::carving

// Carving by photo-consistency: plane sweeps through what stands [SeitzDyer97; KutulakosSeitz00;
// Montenegro03].
#pragma once

#include <cstdint>
#include <span>

#include "carving/statistic.h"
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
  /// What decides whether cameras agree on a voxel.
  Statistic statistic = Statistic::kZncc;
  /// Score in (0, 1) from which a voxel counts as consistent.
  double keep_score = 0.7;
  /// A voxel is carved only if one behind it correlates better by this much. In [0, 1].
  double better_by = 0.2;
  /// Cameras that must see a voxel before its consistency means anything (>= 2).
  int min_views = 3;
  /// Standard deviation of the images' noise, in square-root-encoded units of full scale (> 0).
  double noise_sigma = 0.01;
  /// Texture below this many noise standard deviations tells nothing (>= 0).
  double min_texture = 1.5;
  /// n x n samples a voxel on top of the sampler's own (1 to projtex::kMaxSupersample).
  int supersample = 1;
  /// r-consistency [Kutulakos00]: pixels around a voxel's projection within which each view may
  /// show it, in [0, kMaxSearchRadius]; 0: at its projection only.
  double search_radius = 0;
  /// Reference planes through the voxels' front faces instead of their centres.
  bool front_face = false;
  /// Who sees a voxel.
  visibility::SweepTest visibility = visibility::kDefaultSweepTest;
  /// Constant bias of the visibility test, voxels (>= 0).
  double depth_bias = 2.5;
  /// Layers behind an inconsistent voxel that are searched for a better explanation (>= 1).
  int max_path = 64;
  /// Rounds of six sweeps at most (>= 1).
  int max_rounds = 4;

  void validate() const;  ///< throws UsageError naming the field
};

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

/// Carves `hull` and returns the result with a sub-voxel distance where something was carved; what
/// was not touched keeps the hull's distance. `cameras` and `images` are in the same order.
SparseVolume carve_photo(gpu::Context& context, const SparseVolume& hull,
                         const projtex::ImageSet& images, std::span<const Camera> cameras,
                         const PhotoOptions& options, Progress& progress,
                         PhotoReport* report = nullptr);
/// The same with the sampler that the images were made for. What they show as background does not
/// count.
SparseVolume carve_photo(gpu::Context& context, const SparseVolume& hull,
                         const projtex::SampleImages& images, std::span<const Camera> cameras,
                         const PhotoOptions& options, Progress& progress,
                         PhotoReport* report = nullptr);

}  // namespace photohull::carving

// Photo-consistency of patches at offsets along their normals (refine_match_patches.comp.glsl).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gpu/context.h"
#include "projtex/device_views.h"
#include "projtex/gpu_views.h"
#include "projtex/image_set.h"
#include "refine/match.h"
#include "refine/view_choice.h"

namespace photohull::refine {

/// What a patch is, and how its images are compared.
struct PatchRules {
  int radius = kPatchRadius;   ///< taps to every side; 1: all places of 3 x 3
  double least_spacing = 0.4;  ///< voxels between taps, at least
  double pixel_spacing = 1;    ///< pixels of the reference view between taps, at least
  double best_pairs = 0.4;     ///< share of the pairs of views that a score is the mean of
  double noise_sigma = 0;      ///< of the images, square-root encoding
};

PatchRules patch_rules(const MatchOptions& options, double noise_sigma);

struct PatchSurfel {
  glm::vec3 position{0}, normal{0};  ///< voxels; unit
  float offset_scale = 1;            ///< what the offsets are multiplied with
};

/// Matches surfels of one grid in the images, which outlive it.
class PatchMatcher {
 public:
  /// `cameras`, on the grid, and `images` are in the same order; `launch` is the name of the
  /// dispatches.
  PatchMatcher(gpu::Context& context, const projtex::ImageSet& images,
               std::span<const projtex::GridCamera> cameras, const PatchRules& rules,
               const char* launch);

  /// Score in [-1, 1] of every surfel moved by each offset, in the views chosen for it, one choice
  /// a surfel. Patches bend as `bends` (one a surfel, see curvatures()) says; empty: they are
  /// planes. Throws Error when the device cannot hold a batch.
  Matches match(std::span<const PatchSurfel> surfels, std::span<const glm::vec3> bends,
                std::span<const ViewChoice> choices, const OffsetRange& range) const;
  /// The same for many planes that share few choices, kMostAlike at most: `choice_of` numbers each
  /// surfel's.
  Matches match_alike(std::span<const PatchSurfel> surfels, std::span<const ViewChoice> choices,
                      std::span<const std::uint32_t> choice_of, const OffsetRange& range) const;
  /// Matches::texture and samples alone, of flat patches where the surfels are: nothing is
  /// compared.
  Matches textures(std::span<const PatchSurfel> surfels, std::span<const ViewChoice> choices) const;
  /// The same for surfels that share few choices.
  Matches textures_alike(std::span<const PatchSurfel> surfels, std::span<const ViewChoice> choices,
                         std::span<const std::uint32_t> choice_of) const;
  static constexpr std::size_t kMostAlike = 1 << 16;

 private:
  struct Batch;
  Matches match_all(Batch all, const OffsetRange& range) const;
  void match(const Batch& batch, Matches& out) const;

  gpu::Context& context_;
  const projtex::ImageSet& images_;
  std::vector<shaders::GpuView> gpu_views_;
  projtex::DeviceViews views_;
  PatchRules rules_;
  const char* launch_;
};

}  // namespace photohull::refine

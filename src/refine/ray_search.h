// Private to module refine: places along rays that photographs agree on.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "gpu/context.h"
#include "projtex/image_set.h"
#include "refine/kernels/match_patches.h"
#include "refine/ray_partners.h"
#include "refine/vote.h"

namespace photohull::refine {

/// A ray of one view through a grid; lengths in voxels.
struct Ray {
  int x = 0, y = 0;                  ///< on the lattice of the view's rays
  glm::dvec3 from{0}, direction{0};  ///< direction unit, away from the camera
  double length = 0;
  double depth_per_length = 1;  ///< along the optical axis
  double surface = -1;          ///< where it meets a known surface, from `from`; negative: nowhere
  int tile = 0;                 ///< of its view: which views it is matched with
  int seed = -1;                ///< what its tries go by; negative: its number
};

/// A small plane across a ray.
struct RayPlane {
  double along = -1;     ///< voxels from the ray's start; negative: nothing
  glm::dvec3 normal{0};  ///< unit, towards the camera
  float score = -1;      ///< [-1, 1]
};

/// What a ray found: a plane that the views show alike.
struct Finding : RayPlane {
  bool known = false;        ///< given, not searched for
  bool moved = false;        ///< to a plane that shows the views more alike than any that was swept
  std::vector<float> swept;  ///< scores of patches that face the camera
  double step = 1;           ///< voxels between these

  /// By how much the score is above those swept elsewhere on the ray; of a plane that moved, above
  /// their peaks alone, for the sweep's patches are as unlike as the plane's slope makes them.
  double lead() const;
};

/// Searches the rays of one view after another.
class RaySearch {
 public:
  /// `images` and `cameras` are in the same order, on the grid of the rays.
  RaySearch(gpu::Context& context, const projtex::ImageSet& images,
            std::span<const projtex::GridCamera> cameras, double noise_sigma,
            const VoteOptions& options);

  /// Calls decide(i, scores) with the scores of `count` patches across the i-th ray, `step_of`
  /// voxels apart from its start on. Throws Error when the device cannot hold a batch.
  using Decide = std::function<void(std::size_t, const float*)>;
  void scores_along(std::span<const Ray> rays, const ViewPartners& partners, int count,
                    const Decide& decide) const;

  /// Shares of the variance at the rays' ends in the reference view that noise does not explain.
  std::vector<float> textures(std::span<const Ray> rays, const ViewPartners& partners) const;

  /// The best places along the rays for patches that face the camera; known findings stay.
  void sweep(std::span<const Ray> rays, const ViewPartners& partners,
             std::span<Finding> findings) const;

  /// PatchMatch [Barnes09, Bleyer11]: each ray that is not known tries its neighbours' planes, the
  /// plane through their places, and planes a little off its own, finer by half with every round.
  /// Rays are left out that have found nothing near the least score that tells anything, and whose
  /// neighbours have not either.
  /// `width`, `height`: of the lattice.
  void spread(std::span<const Ray> rays, int width, int height, const ViewPartners& partners,
              std::span<Finding> findings) const;

 private:
  PatchMatcher matcher_;
  const VoteOptions& options_;
};

}  // namespace photohull::refine

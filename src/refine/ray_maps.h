// Private to module refine: coarse depth maps of the views.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "core/grid.h"
#include "gpu/context.h"
#include "projtex/photographs.h"
#include "refine/vote.h"

namespace photohull::refine {

class SharedWork;

/// Rays of one view on a lattice of pixels, each with what it found.
struct RayMap {
  double stride = 1;  ///< pixels between rays
  int width = 0, height = 0;
  /// Where the image's edges lie on the lattice, in strides, [0, 2): other than 0 for parts of a
  /// scene, whose photographs are cut, so that rays of all parts are the same.
  glm::dvec2 shift{0};
  std::vector<float> depth;        ///< voxels along the optical axis, row-major
  std::vector<float> weight;       ///< [0, 1]; 0: the ray says nothing
  std::vector<glm::vec3> before;   ///< what rays found before a known surface, voxels
  std::vector<glm::vec3> through;  ///< where rays passed that found what lies behind it, voxels

  /// Where the ray at a place of the lattice passes through the image.
  glm::dvec2 pixel(int x, int y) const { return stride * (glm::dvec2(x, y) + 0.5 - shift) - 0.5; }
};

/// Makes the map of the view with a number. What it was made of outlives it.
using ViewMapper = std::function<RayMap(std::size_t)>;
/// `surface`: null where none is known.
ViewMapper ray_mapper(gpu::Context& context, const SparseVolume& hull, const SparseVolume* surface,
                      const projtex::Photographs& photographs, const VoteOptions& options);

/// For every view, the depths at which its rays through the hull agree best with views near it.
/// `shared`: by way of which others may help; null: nobody does.
std::vector<RayMap> match_rays(gpu::Context& context, const SparseVolume& hull,
                               const projtex::Photographs& photographs, const VoteOptions& options,
                               SharedWork* shared = nullptr);

/// The same where a `surface` on the same grid is known: depths of the surface where it explains
/// what the photographs show, and of what is found elsewhere along the ray where it does not. Rays
/// that do not meet the surface say nothing.
std::vector<RayMap> match_rays_again(gpu::Context& context, const SparseVolume& hull,
                                     const SparseVolume& surface,
                                     const projtex::Photographs& photographs,
                                     const VoteOptions& options, SharedWork* shared = nullptr);

}  // namespace photohull::refine

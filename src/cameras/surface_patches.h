// Tracks from patches of the surface itself, where features are too few. Internal to cameras.
#pragma once

#include <span>
#include <vector>

#include "cameras/feature_tracks.h"
#include "core/box.h"
#include "photo/align_patch.h"

namespace photohull {

struct SurfacePoint {
  glm::dvec3 position{0.0};  ///< world
  glm::dvec3 normal{0.0};    ///< unit, outwards
};

/// Points spread over the visual hull [Laurentini94] of the views' masks by these cameras, within
/// the box, on a grid of `cells` along its longest side; at most `count`. A voxel is empty when two
/// views see background there, or when no view with a mask sees it. None without masks.
std::vector<SurfacePoint> hull_points(std::span<const Camera> cameras,
                                      std::span<const PreparedView> views, const Box& box,
                                      int cells, int count);

struct PatchOptions {
  int radius = 11;               ///< pixels: larger than a feature's, for faint structure
  double least_gradient = 0.1;   ///< sRGB levels a pixel, root mean square in the weaker direction
  double search = 12;            ///< pixels: the surface lies so far below the hull
  int views = 6;                 ///< besides the one that sees the point best
  double largest_angle = 40;     ///< degrees between the views' rays
  double least_agreement = 0.8;  ///< normalised cross-correlation of patches once they are aligned
};

/// Photo-consistency of patches across views: around each point the patch that the view facing it
/// best shows is looked for in its neighbours along the ray through the point, and aligned there by
/// least squares [Gruen85]. Each that agrees in two views or more is a track. Throws Cancelled.
std::vector<Track> patch_tracks(std::span<const Camera> cameras, std::span<const GreyImage> images,
                                std::span<const SurfacePoint> points, const PatchOptions& options,
                                Progress& progress);

/// Where the patch around a pixel of camera a lies in camera b when it shows a plane through
/// `point` with this normal; nothing where b does not see it.
std::optional<PatchPlace> place_on_plane(const Camera& a, const glm::dvec2& pixel, const Camera& b,
                                         const glm::dvec3& point, const glm::dvec3& normal);

}  // namespace photohull

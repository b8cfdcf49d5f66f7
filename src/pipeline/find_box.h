// Where the object is, told by the photographs themselves.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cameras/scene_points.h"
#include "core/box.h"
#include "core/prepared_view.h"
#include "core/progress.h"

namespace photohull::pipeline {

struct FoundBox {
  Box box;             ///< world; no camera stands in it, unless it is a room
  std::string source;  ///< "found: ..." and what it rests on, for the user
  std::vector<std::string> warnings;
  std::vector<ScenePoint> points;  ///< that it holds; empty where silhouettes told
  std::optional<Box> seen;         ///< holds nearly all points, those around the object too
};

/// What is known before the photographs' features are.
struct BoxEvidence {
  std::span<const PreparedView> views;  ///< undistorted; reduced ones do (some 800 pixels)
  bool given_masks = false;          ///< else they were made from the background, and may be wrong
  std::vector<ScenePoint> points{};  ///< of the scene file; those without views count once
};

/// An axis-aligned box around what the photographs are of. In this order:
///  1. Silhouettes, where masks were given whose foreground ends within most photographs: the box
///  of
///     the visual hull (carving/object_box.h), carved from a cube around the point nearest to the
///     rays through the foregrounds' middles.
///  2. Points: the scene file's where there are at least 100, else features of the photographs
///     (cameras/scene_points.h). A point counts once for each view that confirms another. Those go
///     that only a small part of the cameras have on their images (less than half of what the
///     best-seen point has where cameras look from all around, less than a third else), that are
///     farther from where the axes meet than the cameras are (where they do meet), or that are not
///     connected with the many. The box holds all but 0.5 % of the rest's weight on each side, with
///     a margin of 10 % of its sides and 3 % of its diagonal at least. Where it would hold cameras,
///     its sides are drawn in past these. But where nearly all cameras stand among the points, turn
///     all around and at most half of them look at one place, it is a room: the box holds all but
///     0.5 % of all points on each side.
///  3. Silhouettes of masks that were made, with the points where these are fewer than 100.
/// Throws Error, saying what to do, for fewer than two views and where neither features nor
/// silhouettes tell; Cancelled.
FoundBox find_box(const BoxEvidence& evidence, Progress& progress);

/// Where the optical axes meet.
struct AxesMeeting {
  glm::dvec3 point{0.0};       ///< nearest to all axes (least squares), world
  double distance = 0;         ///< of the cameras from it, the median
  std::size_t in_front = 0;    ///< cameras that have it before them
  double turn = 0;             ///< degrees: the largest angle between two axes
  std::size_t meeting = 0;     ///< cameras whose axes pass it by less than a fifth of the distance
  bool looks_inwards = false;  ///< do nearly all axes pass it by less than a fifth of the distance?
};

AxesMeeting meeting_of_axes(std::span<const Camera> cameras);

}  // namespace photohull::pipeline

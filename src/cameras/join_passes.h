// Several passes of photographs of one object, which was laid on another side in between, in one
// world.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cameras/rigid_motion.h"
#include "core/box.h"
#include "core/prepared_view.h"
#include "core/progress.h"

namespace photohull {

/// Photographs during which the object did not move.
struct PhotoPass {
  std::string name;                 ///< for messages
  std::vector<PreparedView> views;  ///< with masks; the pass has a world of its own
  Box box;                          ///< that holds the object there, and no sheet
};

struct JoinedPass {
  RigidMotion motion;     ///< to the first pass's world; of the first: none
  double turn_sigma = 0;  ///< degrees, standard deviation, largest of three axes
  double move_sigma = 0;  ///< of the object's middle, world units, largest of three axes
  /// Pixels, median: how far a point that the photographs of one side of the seam show lies from
  /// where those of the other side have it. Measurement noise of both is part of it.
  double seam = 0;
  double seam_sigma = 0;  ///< pixels: standard deviation, by the motion, of the surface's place
  double outside = 0;     ///< share of the surface's points that masks across the seam leave out
  int points = 0;         ///< of the pass itself, by features
  int matches = 0;        ///< of these: matched with other passes' points, as the motion has it
  int tracks = 0;         ///< features followed across the seam, by which the motion was found
};

/// How the passes lie to each other, by the object's texture: SIFT features [Lowe04] are followed
/// within each pass and triangulated; points of different passes that look alike give motions, and
/// the one that most of them agree on [Fischler81] is taken. Then features are followed across the
/// seam by the cameras, aligned [Gruen85], and the motion is fitted to their pixels [Triggs99]. A
/// pass may be joined to the first one by way of another. Views must be of about one scale.
///
/// Throws Error that says why and what to do where a pass does not fit the others: too few views or
/// points, no motion that twelve pairs agree on, points that leave the motion open by more than a
/// pixel, a surface that masks of the others leave out. Throws Cancelled.
std::vector<JoinedPass> join_passes(std::span<const PhotoPass> passes, Progress& progress);

}  // namespace photohull

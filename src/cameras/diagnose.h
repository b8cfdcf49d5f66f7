// What is wrong with a scene's cameras, measured on its photographs.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cameras/frontier.h"
#include "core/box.h"
#include "core/prepared_view.h"
#include "core/progress.h"

namespace photohull {

/// One way to understand poses that were given as cam_from_world.
struct PoseReading {
  bool inverted = false;          ///< the given matrix is world_from_cam
  std::array<bool, 3> flipped{};  ///< the given camera's axes x, y, z point the other way
  double explained = 0;           ///< share of the matches, [0, 1]
  double residual = 0;            ///< pixels, median distance from the epipolar lines; infinite
                                  ///< where most matches have no point in front of both cameras

  bool as_given() const { return !inverted && !flipped[0] && !flipped[1] && !flipped[2]; }
  /// cam_from_world by this reading.
  Pose pose(const Pose& given) const;
};

std::string to_string(const PoseReading& reading);

/// Do the principal points fit as given, or half a pixel less or more in x and y?
struct PixelCentreFit {
  static constexpr std::array<double, 3> kShifts = {-0.5, 0, 0.5};

  bool tells = false;  ///< is the shift certain enough to tell the three apart?
  double best = 0;     ///< of kShifts, where it tells
  double shift = 0;    ///< pixels, where the residuals are least
  double sigma = 0;    ///< pixels, standard deviation of it; infinite where nothing is known
  std::array<double, 3> tracks{}, tangents{};  ///< pixels, root mean square, for each of kShifts
  int track_count = 0, tangent_count = 0;      ///< inliers
};

/// A view against the others.
struct ViewFit {
  enum class By {
    kMatches,      ///< median over its pairs of views of their median epipolar distances
    kSilhouettes,  ///< the same of the silhouettes' tangents, where there are too few matches
    kTracks        ///< median distance from where two or more other views put its tracks' points
  };

  double residual = 0;  ///< pixels
  double others = 0;    ///< pixels, what is usual with the other views
  int count = 0;        ///< of pairs, tangents or tracks; 0: nothing is known of this view
  By by = By::kMatches;
  bool disagrees = false;
};

/// The box against the cameras and what they see.
struct BoxFit {
  int seen_by = 0;  ///< views that have part of it on their image
  int cameras_inside = 0;
  double diagonal = 0;         ///< world
  double distance = 0;         ///< world, median from the cameras to its centre
  int points = 0;              ///< matches with a point in space
  double points_inside = 0;    ///< share of the points that lie in the box
  double points_diagonal = 0;  ///< world, of the box around them, a twentieth cut off at each end
  double points_distance = 0;  ///< world, median from the cameras to their middle
};

struct CameraDiagnosis {
  int pairs = 0, matches = 0;         ///< of views and of features, found without the poses
  std::vector<PoseReading> readings;  ///< best first; empty where there are too few matches
  PoseReading given;                  ///< the one that the scene's reader chose
  bool misread = false;               ///< readings[0] is clearly better
  /// The rest is only known when the poses are right to some pixels: not when `misread`.
  std::optional<PixelCentreFit> pixel_centre;
  std::vector<ViewFit> views;
  double usual_residual = 0;  ///< pixels, median over the views that agree, of matches
  std::optional<BoxFit> box;
  std::vector<std::string> faults;  ///< sentences, with numbers; empty for cameras in order
  std::vector<std::string> notes;   ///< what could not be told, and why
};

/// Matches features without the poses and asks which reading explains them; then which views
/// disagree, which shift of the principal point fits tracks (find_tracks) and the silhouettes'
/// tangents (frontier_pairs), and whether the box is where matched points are. The shift's standard
/// deviation comes from leaving out one view after the other (the jackknife). Views are
/// undistorted. Costs about half a second a view. Throws Cancelled.
CameraDiagnosis diagnose_cameras(std::span<const PreparedView> views, const std::optional<Box>& box,
                                 Progress& progress);

/// Each view's silhouette against the others', by the tangents that planes through two cameras
/// have in common (frontier_pairs). Needs no texture, and a tenth of a second.
/// `cameras`: one for each view, in place of the view's own.
std::vector<ViewFit> fit_silhouettes(std::span<const Camera> cameras,
                                     std::span<const PreparedView> views);
/// The same, of outlines that are known (outlines_of).
std::vector<ViewFit> fit_silhouettes(std::span<const Camera> cameras,
                                     std::span<const Outline> outlines);

/// Pixels between tangents of outlines from which on cameras or masks look wrong.
inline constexpr double kSuspiciousTangents = 0.25;

/// Pixels by which the outline of each view is off what the others say (fit_silhouettes), for views
/// that are off by more than kSuspiciousTangents and clearly more than is usual; else 0. Where more
/// than a quarter are, nobody can say who is right, and all are 0. A shift d
/// moves a tangent by d |cos a|, where a is the angle between the shift and the tangent's normal;
/// the median over all directions is d / sqrt(2).
std::vector<double> outlines_off(std::span<const Camera> cameras,
                                 std::span<const PreparedView> views);
/// The same, of fits that are known (fit_silhouettes).
std::vector<double> outlines_off(std::span<const ViewFit> fits);

}  // namespace photohull

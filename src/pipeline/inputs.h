// What a job works on: photographs, cameras, silhouettes and the lattice, read, checked and mended.
#pragma once

#include <cmath>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "assess/common_error.h"
#include "cameras/frontier.h"
#include "cameras/refine_cameras.h"
#include "carving/hull.h"
#include "core/grid.h"
#include "core/progress.h"
#include "core/scene.h"
#include "masks/silhouette.h"
#include "pipeline/reconstruct.h"
#include "views/prepare_views.h"

namespace photohull::pipeline {

/// For messages.
inline double hundredths(double pixels) { return std::round(100 * pixels) / 100; }

/// The stages before the hull, in the order of their declaration; each fills the members that it is
/// named for, and the report. They throw Error, UsageError or Cancelled.
class Inputs {
 public:
  Inputs(const ReconstructOptions& options, Report& report, Progress& progress)
      : options_(options), report_(report), progress_(progress) {}

  void load();
  /// Reads the photographs as large as the voxels need them.
  void prepare();
  /// By default only where silhouettes tell at once that the cameras disagree.
  void refine_cameras();
  void tighten_box();
  void fit_grid();
  void crop();
  void measure_silhouettes();
  void correct_masks();
  /// Of the masks as they are from here on: their lines, and the outlines' convex hulls.
  void trace_outlines();
  void leave_out_wrong_views();
  /// Tells the views how sharp they are beside the others, and leaves strongly blurred ones out.
  void measure_sharpness();
  /// Gives silhouettes that are a little off as much room as they are off, and finds out what one
  /// view's evidence is worth.
  void bear_disagreement();
  /// Gives stems and wires the room that voxels need; their width is known from `lines`.
  void widen_lines();
  /// Puts what masks show and not all views bear into the silhouettes that leave it out.
  void explain_foreground();

  bool any_mask() const;
  /// Is what surrounds the box to be reconstructed too, if silhouettes do not bound the object?
  bool has_surroundings() const;
  /// Frees the masks' pixels, if no view needs them for its lines or the verdict.
  void forget_masks();
  /// What the hull and the refinement go by, one a view.
  std::vector<carving::Silhouette> silhouettes_of_views() const;
  void warn(const std::string& text);

  Scene scene;
  std::optional<Box> seen;  ///< around what the photographs show, where the box was found
  GridSpec grid;
  std::vector<View> views;  ///< undistorted, and from crop() on around the box alone
  std::vector<Camera> cameras;
  /// Of `widened` where there is one, else of the masks.
  std::vector<SilhouetteDistance> silhouettes;
  std::vector<std::vector<LinePoint>> lines;  ///< of the masks, a list a view
  /// The masks with room around their lines, and with what other views put into them; an empty one
  /// where nothing changed.
  std::vector<Mask> widened;
  double full_evidence = 0;          ///< pixels (HullOptions)
  assess::CommonError common_error;  ///< of the outlines of the views that are left
  double contradiction = 0;  ///< share of the silhouettes' rays that other silhouettes leave empty
  double cameras_moved = 0;  ///< by refinement, pixels
  double cameras_moved_alike = 0;  ///< of it what all views have in common

 private:
  /// Scales for `box`; as small as memory needs them.
  std::vector<double> choose_scales(const Box& box);
  std::int64_t memory_limit() const;
  void take_scales(std::vector<double> scales);
  /// Decodes the photographs at the scales taken.
  PreparedViews decode();
  void forget_masks_made_within();
  void mend_given_masks(std::span<const MaskJudgement> masks);
  GridSpec lattice(std::span<const Camera> cameras) const;
  void refine_cameras_of(const std::vector<double>& off);
  void use_cameras(const CameraRefinement& found);
  void remember_right_cameras(const CameraRefinement& found, bool used);
  void leave_out(std::span<const int> wrong, const std::string& why);
  void drop_view(int index);
  /// Puts thin parts that masks have lost, by `eaten` pixels around every outline, back into them.
  void restore_eaten(double eaten);
  /// Do the silhouettes leave no more of their foreground unexplained with these cameras?
  bool fill_no_less(std::span<const Camera> refined) const;
  /// Are the masks too small, as the photographs tell?
  bool masks_are_eaten() const;

  bool box_found_ = false;               ///< not given
  Scene full_;                           ///< the scene in the files' pixels, until they are decoded
  std::vector<double> scales_;           ///< of its views
  bool short_of_memory_ = false;         ///< were these made smaller by --max-memory?
  std::vector<Outline> outlines_;        ///< of the masks, one a view
  std::vector<double> room_;             ///< pixels around each view's outline, for what it is off
  bool restored_ = false;                ///< were eaten stems put back into the masks?
  std::set<std::string> right_cameras_;  ///< names of views
  std::set<std::string> made_masks_;     ///< names of views whose masks come from the background

  const ReconstructOptions& options_;
  Report& report_;
  Progress& progress_;
};

}  // namespace photohull::pipeline

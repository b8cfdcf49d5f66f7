// The problem that lenses, poses and the sheet's bend are found by. Internal to calib; only for
// files that know Ceres.
#pragma once

#include <map>

#include "calib/pose_photographs.h"
#include "calib/sheet_model.h"

namespace photohull {

/// A lens, and what is known of it.
struct SheetCamera {
  std::string name;
  glm::ivec2 size{0};
  double stated_focal = 0;  ///< pixels; 0: none
  Lens lens{};
  std::vector<std::size_t> photos;  ///< with a pose or to be given one, ascending
};

/// A photograph on its way to a pose.
struct SheetPhoto {
  BoardView view;                  ///< points that count, millimetres
  std::vector<std::size_t> group;  ///< of each point: its tag, or a saddle by itself
  std::vector<glm::dvec2> moved;   ///< around a cylinder: pixels that were taken off each pixel
  std::size_t camera = 0;
  Rigid pose{};
  double noise = 0.5;  ///< pixels, of its points
  bool used = false;
};

struct SheetProblem {
  LensModel model = LensModel::kBrown;
  double reach = 1;  ///< mm, at which Bend is measured
  std::vector<SheetCamera> cameras;
  std::vector<SheetPhoto> photos;
  Bend bend{};
  bool stretches = false;  ///< the bend may be any; else it is that of paper
  bool flat = true;        ///< false: points lie around a cylinder

  /// Pixels, of each point of a photograph.
  std::vector<double> errors(const SheetPhoto& photo) const;
  /// Pixels, root mean square.
  double rms(const SheetPhoto& photo) const;
  /// Around a cylinder the upper and lower edges of a tag are arcs, and the lines that are fitted
  /// to them lie between an arc and its chord: takes off what that moves corners by, as the
  /// photographs' poses and lenses are now.
  void follow_arcs();
  /// Refines all that is used. `bent`: the bend too. Returns the cost.
  double refine(bool bent);

  struct Deviations {
    Bend bend{};
    std::map<std::size_t, std::vector<double>> lenses, poses;  ///< by camera, by photograph
    double object_error = 0;                                   ///< pixels
  };
  /// Of the state as it is; `low` and `high`: the box of the object, mm.
  Deviations deviations(bool bent, const glm::dvec3& low, const glm::dvec3& high);

 private:
  void add_all(ceres::Problem& problem, bool bent);
};

/// Cameras by name, with lenses from what files state or from homographies [Zhang00], and a pose
/// for each photograph that is used [Collins14]; one that gets none is not used any more. Around a
/// cylinder poses are from points in space [Terzakis20], and a focal length that is not stated is
/// the one of some that they fit best.
void start_sheet_problem(const std::vector<PosePhoto>& photos, SheetProblem& problem);

/// Takes tags out of a view that no plane has where the others are, by RANSAC; returns how many.
int drop_wrong_tags(SheetPhoto& photo);

}  // namespace photohull

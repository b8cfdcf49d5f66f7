// Photographs of an object on a printed sheet, in any order: lenses, poses and scale.
#pragma once

#include <string>
#include <vector>

#include "calib/find_tags.h"
#include "core/box.h"
#include "core/describe.h"

namespace photohull {

/// A photograph in which the sheet was looked for.
struct PosePhoto {
  SheetView view;
  std::string camera;  ///< photographs of one lens at one zoom and size have the same name here
  double focal = 0;    ///< pixels, as the file states it; 0: it does not
};

struct PoseOptions {
  LensModel lens = LensModel::kBrown;
  double bar = 0;     ///< of the printed bar as measured, mm; 0: as the sheet says
  double height = 0;  ///< of the box above the sheet, mm; 0: the longer side of the free space, but
                      ///< no more than photographs show (lowered_to_seen)
  double margin = 1;  ///< from the sheet up to the box, mm
  double unit = 1;    ///< of the world, mm
  bool flat = false;  ///< do not find out whether the sheet is bent
};

void describe(Described& to, PoseOptions& options);

/// A lens that some of the photographs share.
struct PosedCamera {
  std::string name;
  Intrinsics intrinsics;
  Distortion distortion;
  double stated_focal = 0;                      ///< pixels; 0: found from the tags alone
  double focal_sigma = 0, principal_sigma = 0;  ///< pixels, standard deviations (largest of x, y)
  int photographs = 0;                          ///< that are posed
};

struct PosedPhoto {
  bool posed = false;
  std::string reason;  ///< one sentence: why it is not
  int camera = 0;      ///< index of PoseResult::cameras
  Pose cam_from_world;
  bool placed = false;  ///< it is not posed, but cam_from_world is about right
  int tags_found = 0, tags_used = 0;
  double rms = 0;          ///< pixels, of the points that count
  double turn_sigma = 0;   ///< degrees, standard deviation, largest of three axes
  double place_sigma = 0;  ///< of the camera's place, world units, largest of three axes
};

/// How the sheet departs from the plane z = 0, which touches it at the origin:
/// z = xx x^2 + xy x y + yy y^2.
struct SheetBend {
  bool found = false;  ///< beyond doubt; else all is 0 and the sheet is taken for a plane
  double xx = 0, xy = 0, yy = 0;  ///< per world unit
  double height = 0;              ///< of the page's edges and corners, world units, the largest
  double height_sigma = 0;        ///< its standard deviation
};

/// World: the sheet's frame (sheet.h), z = 0 the paper and z up, in the unit asked for.
struct PoseResult {
  std::vector<PosedCamera> cameras;
  std::vector<PosedPhoto> photos;  ///< as many as were given
  double rms = 0;                  ///< pixels, of all points that count
  double scale = 1;                ///< world units to a millimetre of the sheet as it is described
  double object_error = 0;  ///< pixels, as Calibration has it, of an object that fills the box
  SheetBend bend;
  Box box;  ///< above the free space
  std::vector<std::string> warnings;
};

/// A strip around a cylinder is to be given as_printed, and has no bend.
///
/// Starts from each camera's stated focal length, or from the tags' homographies [Zhang00], and
/// from each photograph's pose by itself [Collins14]. Then lenses, poses and the sheet's bend are
/// one Ceres problem with a robust loss over all corners, from whose covariance the standard
/// deviations come. Tags that are not where the others say, and photographs whose tags do not fit,
/// are left out. The same for the same input, to the bit. Throws UsageError for options that are
/// not legal, Error when no photograph can be posed.
PoseResult pose_photographs(const std::vector<PosePhoto>& photos, const Sheet& sheet,
                            const PoseOptions& options);

}  // namespace photohull

// Cameras calibrated from photographs of a flat board.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/describe.h"
#include "core/image.h"

namespace photohull {

enum class BoardKind {
  kChess,    ///< columns x rows inner corners
  kCharuco,  ///< columns x rows squares with markers in the white ones
  kCircles   ///< columns x rows centres of dots in a grid
};

const char* to_string(BoardKind kind);

struct BoardSpec {
  BoardKind kind = BoardKind::kChess;
  int columns = 9, rows = 6;
  double square = 1;     ///< distance of neighbouring points, world units
  double marker = 0.75;  ///< charuco: the markers' side as a share of a square's
  int dictionary = 0;    ///< charuco: number of OpenCV's predefined dictionary

  /// Throws UsageError naming the option.
  void validate() const;
  /// Looks the same after half a turn, so that its points cannot be told apart from one picture to
  /// another: grids of dots, and chessboards whose columns and rows are both odd or both even. One
  /// camera alone does not mind; rigs and turntables do.
  bool looks_same_turned() const;
};

void describe(Described& to, BoardSpec& board);

/// The board's points that a picture shows, in the board's plane z = 0 and in pixels.
struct BoardView {
  std::string name;
  int width = 0, height = 0;
  std::vector<glm::dvec3> points;
  std::vector<glm::dvec2> pixels;
  /// Circles: a dot's radius in world units, measured; `pixels` are then the middles of the dots'
  /// pictures, off the pictures of their middles. 0: points.
  double dot_radius = 0;

  glm::ivec2 size() const { return {width, height}; }
};

/// OpenCV's detectors (findChessboardCornersSB [Duda18], ArUco [GarridoJurado14],
/// findCirclesGrid), made more precise in linear light. No points where the board is not found.
BoardView find_board(const ColourImage& image, const BoardSpec& board, const std::string& name);

enum class LensModel { kPinhole, kBrown, kRational, kFisheye };

const char* to_string(LensModel model);

/// A camera's lens as it was found before, in pixels of the pictures of the board.
struct KnownLens {
  Intrinsics intrinsics;
  Distortion distortion;
};

struct CalibrateOptions {
  LensModel lens = LensModel::kBrown;
  /// The lens is this one, whatever `lens` says: only poses are found. No skew.
  std::optional<KnownLens> known;
  /// One fixed camera, and a board that turns with the object on a table: all pictures share an
  /// axis, and differ in an angle only.
  bool turntable = false;
  /// Turntable: degrees at which each view was taken, where they are known (empty: they are found).
  /// As many as views; the axis points so that they grow about it by the right-hand rule.
  std::vector<double> angles;

  /// Throws UsageError naming the option.
  void validate(std::size_t views) const;
};

/// Without the lens that is known and the angles.
void describe(Described& to, CalibrateOptions& options);

/// A turntable's axis in the camera's frame.
struct TurntableAxis {
  glm::dvec3 direction{0.0};   ///< unit; the table turns about it by the right-hand rule
  glm::dvec3 point{0.0};       ///< of the axis, nearest to the camera
  std::vector<double> angles;  ///< degrees, of each view; NaN for views left out; 0 for the first
                               ///< where they were not given
  double direction_sigma = 0;  ///< degrees
  double point_sigma = 0;      ///< world units, across the axis
  double angle_sigma = 0;      ///< degrees, largest; 0 where the angles were given
  bool angles_given = false;
};

struct Calibration {
  Intrinsics intrinsics;
  Distortion distortion;
  std::vector<Pose> cam_from_board;  ///< of each view; identity for those left out
  std::vector<double> rms;           ///< pixels, of each view (left out: by the final camera)
  std::vector<bool> left_out;        ///< outliers: their rms is far from the others'
  double all_rms = 0;                ///< pixels, of the views that count
  double focal_sigma = 0, principal_sigma = 0;  ///< pixels, standard deviations (largest of x, y)
  /// What uncertain lens, poses and axis do to a reconstruction: pixels by which points of an
  /// object as large as the board, in its place, are seen elsewhere, in the root mean square over
  /// points and views, less what moving, turning and scaling all of the world can take back.
  /// Infinite where the pictures leave something undetermined.
  double object_error = 0;
  LensModel model = LensModel::kBrown;  ///< as asked for, or that of the known lens
  bool lens_known = false;              ///< CalibrateOptions::known: the lens has no deviations
  std::optional<TurntableAxis> turntable;
};

/// Intrinsics and poses by OpenCV [Zhang00], then refined in one Ceres problem with a robust loss
/// (with `turntable` over the common axis), from which the standard deviations come. Dots are
/// judged by the middles of their pictures, computed through perspective and lens. With a known
/// lens poses come from each view by itself first [Collins14]. Throws Error when fewer than three
/// views (one, where the lens is known) show six points or more, when views' sizes differ, when the
/// problem is degenerate, or when given angles do not fit. What it finds may still be useless:
/// judge_calibration.h.
Calibration calibrate(const std::vector<BoardView>& views, const CalibrateOptions& options);

/// How often each part of the frame was covered by the board's points: a picture, 8-bit grey RGB.
ColourImage coverage_picture(const std::vector<BoardView>& views, const Calibration& calibration);

}  // namespace photohull

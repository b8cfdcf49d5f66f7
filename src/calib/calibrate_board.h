// Cameras calibrated from photographs of a flat board.
#pragma once

#include <optional>
#include <string>
#include <vector>

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
  int columns = 9, rows = 6;  ///< 3 or more each
  double square = 1;          ///< distance of neighbouring points, world units, > 0
  double marker = 0.75;       ///< charuco: the markers' side as a share of a square's, in (0, 1)
  int dictionary = 0;         ///< charuco: number of OpenCV's predefined dictionary, 0 to 20

  /// Throws UsageError naming the option.
  void validate() const;
};

/// The board's points that a picture shows, in the board's plane z = 0 and in pixels.
struct BoardView {
  std::string name;
  int width = 0, height = 0;
  std::vector<glm::dvec3> points;
  std::vector<glm::dvec2> pixels;
};

/// OpenCV's detectors (findChessboardCornersSB [Duda18], ArUco [GarridoJurado14],
/// findCirclesGrid). No points where the board is not found.
BoardView find_board(const ColourImage& image, const BoardSpec& board, const std::string& name);

enum class LensModel { kPinhole, kBrown, kRational, kFisheye };

const char* to_string(LensModel model);

struct CalibrateOptions {
  LensModel lens = LensModel::kBrown;
  /// One fixed camera, and a board that turns with the object on a table: all pictures share an
  /// axis, and differ in an angle only.
  bool turntable = false;
};

/// A turntable's axis in the camera's frame.
struct TurntableAxis {
  glm::dvec3 direction{0.0};   ///< unit
  glm::dvec3 point{0.0};       ///< of the axis, nearest to the board's middle in the first picture
  std::vector<double> angles;  ///< degrees, of each view; 0 for the first; NaN for views left out
  double direction_sigma = 0;  ///< degrees
  double angle_sigma = 0;      ///< degrees, largest
};

struct Calibration {
  Intrinsics intrinsics;
  Distortion distortion;
  std::vector<Pose> cam_from_board;  ///< of each view; identity for those left out
  std::vector<double> rms;           ///< pixels, of each view (left out: by the final camera)
  std::vector<bool> left_out;        ///< outliers: their rms is far from the others'
  double all_rms = 0;                ///< pixels, of the views that count
  double focal_sigma = 0, principal_sigma = 0;  ///< pixels, standard deviations (largest of x, y)
  std::optional<TurntableAxis> turntable;
};

/// Intrinsics and poses by OpenCV [Zhang00], then refined in one Ceres problem with a robust loss
/// (with `turntable` over the common axis), from which the standard deviations come. Throws Error
/// when fewer than three views show six points or more, when views' sizes differ, or when the
/// problem is degenerate.
Calibration calibrate(const std::vector<BoardView>& views, const CalibrateOptions& options);

/// How often each part of the frame was covered by the board's points: a picture, 8-bit grey RGB.
ColourImage coverage_picture(const std::vector<BoardView>& views, const Calibration& calibration);

}  // namespace photohull

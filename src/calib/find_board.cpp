#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <array>

#include "calib/find_board_parts.h"
#include "core/error.h"

namespace photohull {

cv::Mat linear_grey(const ColourImage& image, double blur) {
  cv::Mat grey(image.height, image.width, CV_32F);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const glm::vec4 c = image.linear(x, y);
      grey.at<float>(y, x) = 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b;
    }
  if (blur > 0) cv::GaussianBlur(grey, grey, {}, blur);
  return grey;
}

cv::Mat grey_bytes(const ColourImage& image) {
  cv::Mat grey(image.height, image.width, CV_8U);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const glm::vec4 c = image.linear(x, y);
      const double luminance = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
      grey.at<std::uint8_t>(y, x) =
          cv::saturate_cast<std::uint8_t>(255 * srgb_from_linear(std::clamp(luminance, 0.0, 1.0)));
    }
  return grey;
}

namespace {

constexpr double kMostRows = 1000, kLargestSquare = 1e9;

/// To the saddle points, by gradients in windows of a share of the corners' least spacing.
void refine_corners(const cv::Mat& grey, double share, std::vector<cv::Point2f>& corners) {
  double spacing = 1e9;
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      spacing = std::min(spacing, cv::norm(corners[i] - corners[j]));
  if (corners.size() < 2) return;
  const int half = std::clamp(int(share * spacing), 2, 11);
  const cv::TermCriteria stop(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-4);
  cv::cornerSubPix(grey, corners, {half, half}, {-1, -1}, stop);
}

void add_grid(const std::vector<cv::Point2f>& found, const BoardSpec& board, BoardView& view) {
  for (int i = 0; i < int(found.size()); ++i) {
    view.points.emplace_back(board.square * (i % board.columns), board.square * (i / board.columns),
                             0);
    view.pixels.emplace_back(found[std::size_t(i)].x, found[std::size_t(i)].y);
  }
}

void find_charuco(const cv::Mat& grey, const cv::Mat& linear, const BoardSpec& board,
                  BoardView& view) {
  const auto dictionary = cv::aruco::getPredefinedDictionary(board.dictionary);
  const auto charuco =
      cv::aruco::CharucoBoard::create(board.columns, board.rows, float(board.square),
                                      float(board.square * board.marker), dictionary);
  const auto parameters = cv::aruco::DetectorParameters::create();
  std::vector<std::vector<cv::Point2f>> markers;
  std::vector<int> ids;
  cv::aruco::detectMarkers(grey, dictionary, markers, ids, parameters);
  if (ids.empty()) return;
  std::vector<cv::Point2f> corners;
  std::vector<int> corner_ids;
  cv::aruco::interpolateCornersCharuco(markers, ids, grey, charuco, corners, corner_ids);
  // Not so far as to reach the markers.
  refine_corners(linear, 0.4 * (1 - board.marker), corners);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    // From the grid, in doubles.
    const int column = corner_ids[i] % (board.columns - 1),
              row = corner_ids[i] / (board.columns - 1);
    view.points.emplace_back(board.square * (column + 1), board.square * (row + 1), 0);
    view.pixels.emplace_back(corners[i].x, corners[i].y);
  }
}

}  // namespace

const char* to_string(BoardKind kind) {
  switch (kind) {
    case BoardKind::kChess:
      return "chess";
    case BoardKind::kCharuco:
      return "charuco";
    case BoardKind::kCircles:
      return "circles";
  }
  return "?";
}

void describe(Described& to, BoardSpec& o) {
  to.choice("board", &o.kind,
            std::array{BoardKind::kChess, BoardKind::kCharuco, BoardKind::kCircles},
            "what is printed on the board");
  to.number("columns", &o.columns, from_to(3, kMostRows), "",
            "inner corners in a row; charuco: squares, circles: dots");
  to.number("rows", &o.rows, from_to(3, kMostRows), "",
            "inner corners in a column; charuco: squares, circles: dots");
  to.number("square", &o.square, above(0, kLargestSquare), "world units",
            "distance of neighbouring corners or dots")
      .expects = "a positive length";
  to.number("marker", &o.marker, {0, 1, true, true}, "",
            "charuco: a marker's side as a share of a square's")
      .expects = "a share between 0 and 1";
  to.number("dictionary", &o.dictionary, from_to(0, 20), "",
            "charuco: number of OpenCV's dictionary");
}

void BoardSpec::validate() const { check_options(*this); }

bool BoardSpec::looks_same_turned() const {
  return kind == BoardKind::kCircles || (kind == BoardKind::kChess && (columns + rows) % 2 == 0);
}

BoardView find_board(const ColourImage& image, const BoardSpec& board, const std::string& name) {
  board.validate();
  BoardView view{name, image.width, image.height, {}, {}, 0};
  const cv::Mat grey = grey_bytes(image);
  const cv::Size size(board.columns, board.rows);
  std::vector<cv::Point2f> found;
  cv::setRNGSeed(1);  // the detectors draw, from numbers of the thread
  try {
    switch (board.kind) {
      case BoardKind::kChess:
        if (cv::findChessboardCornersSB(grey, size, found,
                                        cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_ACCURACY)) {
          refine_corners(linear_grey(image), 0.25, found);
          add_grid(found, board, view);
        }
        break;
      case BoardKind::kCharuco:
        find_charuco(grey, linear_grey(image), board, view);
        break;
      case BoardKind::kCircles:
        if (cv::findCirclesGrid(grey, size, found))
          measure_dots(linear_grey(image, 0), found, board, view);
        break;
    }
  } catch (const cv::Exception& failure) {
    throw Error(concat(name, ": OpenCV's detector failed (", failure.err, ")"));
  }
  return view;
}

}  // namespace photohull

#include "calib/find_tags.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/aruco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "calib/find_board_parts.h"
#include "calib/tag_edges.h"
#include "core/error.h"
#include "core/median.h"

namespace photohull {
namespace {

using Corners = std::vector<cv::Point2f>;

void detect(const cv::Mat& grey, const Sheet& sheet, std::vector<Corners>& corners,
            std::vector<int>& ids) {
  const auto dictionary = cv::aruco::getPredefinedDictionary(tag_dictionary(sheet.dictionary));
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->minMarkerPerimeterRate = 0.02;  // tags of 8 pixels in a frame of 1600
  cv::aruco::detectMarkers(grey, dictionary, corners, ids, parameters);
}

std::array<glm::dvec2, 4> as_quad(const Corners& corners) {
  std::array<glm::dvec2, 4> quad;
  for (std::size_t i = 0; i < 4; ++i) quad[i] = {double(corners[i].x), double(corners[i].y)};
  return quad;
}

/// The tag of each id, where there is one and it was seen once.
std::map<int, Corners> sort_out(const Sheet& sheet, const std::vector<Corners>& corners,
                                const std::vector<int>& ids, SheetView& view) {
  std::map<int, Corners> once;
  std::map<int, int> seen;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const bool ours = std::any_of(sheet.tags.begin(), sheet.tags.end(),
                                  [&](const SheetTag& tag) { return tag.id == ids[i]; });
    if (!ours) {
      ++view.foreign;
      continue;
    }
    ++seen[ids[i]];
    once[ids[i]] = corners[i];
  }
  for (const auto& [id, count] : seen)
    if (count > 1) ++view.twice, once.erase(id);
  return once;
}

/// Where the plane's homography by the tags that were found has a place of the sheet.
struct NearbyPlane {
  std::vector<cv::Point2d> places, pixels;

  /// By the nearest two tags.
  cv::Point2d at(const glm::dvec2& place) const {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < places.size(); i += 4) {
      cv::Point2d middle(0, 0);
      for (std::size_t k = 0; k < 4; ++k) middle += places[i + k] * 0.25;
      order.emplace_back(std::hypot(middle.x - place.x, middle.y - place.y), i);
    }
    std::sort(order.begin(), order.end());
    std::vector<cv::Point2d> from, to;
    for (std::size_t n = 0; n < std::min<std::size_t>(2, order.size()); ++n)
      for (std::size_t k = 0; k < 4; ++k)
        from.push_back(places[order[n].second + k]), to.push_back(pixels[order[n].second + k]);
    const cv::Mat h = cv::findHomography(from, to, 0);
    if (h.empty()) return {-1, -1};
    std::vector<cv::Point2d> in{{place.x, place.y}}, out;
    cv::perspectiveTransform(in, out, h);
    return out[0];
  }
};

/// Saddle points that have a tag beside them, by the gradients around them.
void add_saddles(const cv::Mat& linear, const Sheet& sheet, BoardView& board) {
  if (sheet.saddles.empty() || sheet.squares.empty() || board.points.empty()) return;
  NearbyPlane plane;
  for (std::size_t i = 0; i < board.points.size(); ++i) {
    plane.places.emplace_back(board.points[i].x, board.points[i].y);
    plane.pixels.emplace_back(board.pixels[i].x, board.pixels[i].y);
  }
  const double side = sheet.squares[0][1].x - sheet.squares[0][0].x;
  cv::Mat smooth;
  cv::GaussianBlur(linear, smooth, {}, 0.8);
  for (const glm::dvec2& saddle : sheet.saddles) {
    double near = INFINITY;
    for (const cv::Point2d& p : plane.places)
      near = std::min(near, std::hypot(p.x - saddle.x, p.y - saddle.y));
    if (near > 0.5 * side) continue;
    const cv::Point2d at = plane.at(saddle), right = plane.at(saddle + glm::dvec2(side, 0)),
                      up = plane.at(saddle + glm::dvec2(0, side));
    // Not so far as to reach the tags.
    const double least = std::min(cv::norm(right - at), cv::norm(up - at));
    const int half = std::clamp(int(0.12 * least), 2, 11);
    if (!(least > 12) || at.x < half + 2 || at.y < half + 2 || at.x > linear.cols - half - 3 ||
        at.y > linear.rows - half - 3)
      continue;
    Corners corner{cv::Point2f(at)};
    cv::cornerSubPix(smooth, corner, {half, half}, {-1, -1},
                     {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-4});
    if (cv::norm(cv::Point2d(corner[0]) - at) > half) continue;
    board.points.emplace_back(saddle, 0.0);
    board.pixels.emplace_back(corner[0].x, corner[0].y);
  }
}

}  // namespace

double SheetView::edge_width() const {
  if (edges.empty()) return 0;
  std::vector<double> widths;
  for (const EdgeWidth& edge : edges) widths.push_back(edge.width);
  return median(widths);
}

SheetView find_tags(const ColourImage& image, const Sheet& sheet, const std::string& name) {
  SheetView view;
  view.board = {name, image.width, image.height, {}, {}, 0};
  const cv::Mat grey = grey_bytes(image), linear = linear_grey(image, 0);
  try {
    std::vector<Corners> corners;
    std::vector<int> ids;
    detect(grey, sheet, corners, ids);
    const int cells = int(tag_cells(sheet.dictionary, sheet.tags[0].id).size());
    for (const auto& [id, quad] : sort_out(sheet, corners, ids, view)) {
      const auto measured = measure_tag(linear, as_quad(quad), cells);
      if (!measured) continue;
      const auto tag = std::find_if(sheet.tags.begin(), sheet.tags.end(),
                                    [&, id = id](const SheetTag& t) { return t.id == id; });
      view.tags.push_back(id);
      const auto& c = measured->corners;
      view.edges.push_back({0.25 * (c[0] + c[1] + c[2] + c[3]), measured->edge_width});
      for (std::size_t i = 0; i < 4; ++i) {
        view.board.points.push_back(sheet.at(tag->corners[i]));
        view.board.pixels.push_back(measured->corners[i]);
      }
    }
    add_saddles(linear, sheet, view.board);
    if (ids.empty()) {
      cv::Mat flipped;
      cv::flip(grey, flipped, 1);
      detect(flipped, sheet, corners, ids);
      view.mirrored = ids.size() > 1;
    }
  } catch (const cv::Exception& failure) {
    throw Error(concat(name, ": OpenCV's detector failed (", failure.err, ")"));
  }
  return view;
}

}  // namespace photohull

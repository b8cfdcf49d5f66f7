#include "pipeline/box_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "core/error.h"
#include "core/image_scale.h"
#include "core/option_word.h"
#include "core/scaled_size.h"
#include "io/image_file.h"
#include "masks/masks.h"
#include "pipeline/box_picture_parts.h"
#include "views/undistort.h"

namespace photohull::pipeline {
namespace picture {

cv::Size text_size(const std::string& text, double size) {
  int base = 0;
  const cv::Size s = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, 1, &base);
  return {s.width + 6, s.height + base + 2};
}

void put_text(cv::Mat& picture, const std::string& text, cv::Point at, double size,
              const cv::Scalar& colour) {
  const cv::Size s = text_size(text, size);
  const cv::Rect whole({0, 0}, picture.size());
  cv::Rect ground(std::clamp(at.x, 0, std::max(0, whole.width - s.width)),
                  std::clamp(at.y - s.height / 2, 0, std::max(0, whole.height - s.height)), s.width,
                  s.height);
  cv::Mat under = picture(ground & whole);
  under = 0.35 * under;
  cv::putText(picture, text, {ground.x + 3, ground.y + s.height - 5}, cv::FONT_HERSHEY_SIMPLEX,
              size, colour, 1, cv::LINE_AA);
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", std::abs(value) < 1e-12 ? 0.0 : value);
  return text;
}

glm::dvec3 corner(const Box& box, int i) {
  return {i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
          i & 4 ? box.max.z : box.min.z};
}

namespace {

constexpr int kFrame = 24;           // pixels of the panel around photograph and box
constexpr double kMostBeside = 0.5;  // of the photograph's size, for a box beside it
constexpr int kInset = 190;          // pixels, of the magnified part
constexpr double kInsetVoxels = 12;  // across it
constexpr std::size_t kPhotographs = 3;

/// Views that have the box's middle on their images, from sides that differ most.
std::vector<std::size_t> telling_views(const Scene& scene) {
  std::vector<std::size_t> candidates, chosen;
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    const auto pixel = scene.views[i].camera.project(scene.box->center());
    if (pixel && scene.views[i].camera.on_image(*pixel)) candidates.push_back(i);
  }
  if (candidates.empty())
    for (std::size_t i = 0; i < scene.views.size(); ++i) candidates.push_back(i);
  const auto side = [&](std::size_t i) {
    return glm::normalize(scene.views[i].camera.center() - scene.box->center());
  };
  while (chosen.size() < std::min(kPhotographs, candidates.size())) {
    const auto likeness = [&](std::size_t i) {
      double most = -1;
      for (const std::size_t c : chosen) most = std::max(most, glm::dot(side(i), side(c)));
      return most;
    };
    chosen.push_back(
        *std::min_element(candidates.begin(), candidates.end(),
                          [&](std::size_t a, std::size_t b) { return likeness(a) < likeness(b); }));
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

PreparedView load(const SourceView& source, double scale) {
  PreparedView view{source.name, source.camera, io::read_image(source.image, scale), {}};
  view.camera.intrinsics = scaled_intrinsics(view.camera.intrinsics, scale);
  make_opaque(view.image);
  undistort(source.distortion, 2, view);
  return view;
}

cv::Mat bgr(const ColourImage& image) {
  cv::Mat out(image.height, image.width, CV_8UC3);
  const bool srgb = image.encoding == ColourImage::Encoding::kSrgb8;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::size_t at = 4 * (std::size_t(y) * image.width + x);
      cv::Vec3b& pixel = out.at<cv::Vec3b>(y, x);
      if (srgb)
        pixel = {image.bytes[at + 2], image.bytes[at + 1], image.bytes[at]};
      else
        for (int c = 0; c < 3; ++c)
          pixel[2 - c] = std::uint8_t(std::lround(
              255 * srgb_from_linear(std::clamp(double(image.linear(x, y)[c]), 0.0, 1.0))));
    }
  return out;
}

/// A photograph's place on its panel.
struct Placed {
  Camera camera;  ///< of the shrunk photograph
  cv::Point2d origin;
  cv::Point2d at(const glm::dvec2& pixel) const { return origin + cv::Point2d(pixel.x, pixel.y); }
};

/// The part of a segment before the camera, on the panel.
std::optional<std::pair<cv::Point2d, cv::Point2d>> segment(const Placed& placed,
                                                           const glm::dvec3& from,
                                                           const glm::dvec3& to) {
  const double a = placed.camera.to_camera(from).z, b = placed.camera.to_camera(to).z;
  const double nearest = 1e-3 * glm::distance(from, to);
  if (a < nearest && b < nearest) return std::nullopt;
  const auto cut = [&](const glm::dvec3& p, double z, const glm::dvec3& q, double w) {
    return z >= nearest ? p : p + (nearest - z) / (w - z) * (q - p);
  };
  const auto p = placed.camera.project(cut(from, a, to, b)),
             q = placed.camera.project(cut(to, b, from, a));
  if (!p || !q) return std::nullopt;
  return std::pair(placed.at(*p), placed.at(*q));
}

/// OpenCV draws no lines between points that are very far off.
void draw_line(cv::Mat& panel, cv::Point2d p, cv::Point2d q, const cv::Scalar& colour, int width) {
  const cv::Rect room(-kPanelWidth, -kPanelHeight, 3 * kPanelWidth, 3 * kPanelHeight);
  constexpr double kFar = 1e7;
  for (cv::Point2d* end : {&p, &q}) {
    end->x = std::clamp(end->x, -kFar, kFar);
    end->y = std::clamp(end->y, -kFar, kFar);
  }
  cv::Point2l a(long(std::lround(p.x)), long(std::lround(p.y))),
      b(long(std::lround(q.x)), long(std::lround(q.y)));
  a -= cv::Point2l(room.tl()), b -= cv::Point2l(room.tl());
  if (!cv::clipLine(cv::Size2l(room.width, room.height), a, b)) return;
  cv::line(panel, cv::Point(a) + room.tl(), cv::Point(b) + room.tl(), colour, width, cv::LINE_AA);
}

void draw_edges(cv::Mat& panel, const Placed& placed, const Box& box) {
  int farthest = 0;
  for (int i = 1; i < 8; ++i)
    if (placed.camera.to_camera(corner(box, i)).z >
        placed.camera.to_camera(corner(box, farthest)).z)
      farthest = i;
  for (const bool front : {false, true})  // what is nearer over what is behind
    for (int i = 0; i < 8; ++i)
      for (int axis = 0; axis < 3; ++axis) {
        const int other = i | 1 << axis;
        if (other == i || front != (i != farthest && other != farthest)) continue;
        const auto drawn = segment(placed, corner(box, i), corner(box, other));
        if (!drawn) continue;
        const cv::Scalar colour = front ? kAxis[axis] : 0.75 * kAxis[axis];
        draw_line(panel, drawn->first, drawn->second, cv::Scalar(0, 0, 0), front ? 4 : 2);
        draw_line(panel, drawn->first, drawn->second, colour, front ? 2 : 1);
      }
}

void draw_corners(cv::Mat& panel, const Placed& placed, const Box& box, const cv::Rect& taken) {
  std::vector<cv::Rect> used{taken};
  const cv::Rect room(0, kTitle, kPanelWidth, kPanelHeight - kTitle);
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 p = corner(box, i);
    const auto pixel = placed.camera.project(p);
    if (!pixel) continue;
    const cv::Point2d at = placed.at(*pixel);
    if (!room.contains(cv::Point(at))) continue;
    const std::string text = concat(number(p.x), " ", number(p.y), " ", number(p.z));
    const cv::Size size = text_size(text);
    // The nearest free place.
    std::optional<cv::Rect> place;
    double least = 1e300;
    for (int dy = -140; dy <= 140; dy += 7)
      for (const int dx : {9, -9 - size.width, -size.width / 2, 60, -60 - size.width}) {
        const cv::Rect r(int(at.x) + dx, int(at.y) + dy - size.height / 2, size.width, size.height);
        const double off = std::abs(dy) + 0.6 * std::abs(dx + size.width / 2);
        const bool free =
            (r & room) == r && !r.contains(cv::Point(at)) &&
            std::none_of(used.begin(), used.end(), [&](auto& u) { return (u & r).area() > 0; });
        if (free && off < least) least = off, place = r;
      }
    if (!place) continue;
    used.push_back(*place);
    const cv::Point near(std::clamp(int(at.x), place->x, place->x + place->width),
                         place->y + place->height / 2);
    cv::line(panel, at, near, kInk, 1, cv::LINE_AA);
    cv::circle(panel, at, 4, kInk, cv::FILLED, cv::LINE_AA);
    put_text(panel, text, {place->x, place->y + place->height / 2});
  }
}

/// The photograph's own pixels around the box's middle, magnified, under a grid of voxels.
void draw_inset(cv::Mat& panel, const PreparedView& view, const Box& box, double voxel_size,
                const cv::Rect& place) {
  const auto middle = view.camera.project(box.center());
  const double depth = view.camera.to_camera(box.center()).z;
  if (!middle || !view.camera.on_image(*middle)) return;
  const double voxel = voxel_size * view.camera.intrinsics.fx / depth;  // pixels
  const double across = std::max(4.0, kInsetVoxels * voxel);
  const int side = std::min({int(std::ceil(across)), view.image.width, view.image.height});
  const int x = std::clamp(int(middle->x) - side / 2, 0, view.image.width - side),
            y = std::clamp(int(middle->y) - side / 2, 0, view.image.height - side);
  ColourImage part{side, side, view.image.encoding, false, {}};
  const std::size_t bytes = view.image.bytes_per_pixel();
  for (int row = 0; row < side; ++row) {
    const auto* from = &view.image.bytes[bytes * (std::size_t(y + row) * view.image.width + x)];
    part.bytes.insert(part.bytes.end(), from, from + bytes * std::size_t(side));
  }
  cv::Mat inset = panel(place);
  cv::resize(bgr(part), inset, inset.size(), 0, 0, cv::INTER_NEAREST);
  const double step = voxel * place.width / side;
  for (double at = step; at < place.width; at += step) {
    cv::line(inset, {int(at), 0}, {int(at), place.height}, kBoxEdge, 1);
    cv::line(inset, {0, int(at)}, {place.width, int(at)}, kBoxEdge, 1);
  }
  cv::rectangle(panel, place, kInk, 1);
}

/// Where the photograph lies on its panel: made smaller and moved, as far as it stays legible, so
/// that the box fits, too.
cv::Rect place_on_panel(const Camera& camera, const Box& box) {
  const Intrinsics& k = camera.intrinsics;
  const glm::dvec2 room(kPanelWidth - kInset - 3 * kFrame, kPanelHeight - kTitle - 2 * kFrame);
  const glm::dvec2 size(k.width, k.height);
  glm::dvec2 low(0.0), high = size;
  for (int i = 0; i < 8; ++i)
    if (const auto pixel = camera.project(corner(box, i))) {
      low = glm::max(glm::min(low, *pixel), -kMostBeside * size);
      high = glm::min(glm::max(high, *pixel), (1 + kMostBeside) * size);
    }
  const glm::dvec2 fits = room / (high - low);
  const double factor = std::min(fits.x, fits.y);
  const glm::dvec2 corner =
      glm::dvec2(kFrame, kTitle + kFrame) + 0.5 * (room - factor * (high - low)) - factor * low;
  return {int(corner.x), int(corner.y), std::max(1, int(factor * size.x)),
          std::max(1, int(factor * size.y))};
}

cv::Mat draw_photograph(const PreparedView& view, std::size_t index, const Box& box,
                        double voxel_size) {
  cv::Mat panel(kPanelHeight, kPanelWidth, CV_8UC3, kPaper);
  const cv::Rect place = place_on_panel(view.camera, box);
  cv::Mat small;
  cv::resize(bgr(view.image), small, place.size(), 0, 0,
             place.width < view.image.width ? cv::INTER_AREA : cv::INTER_LINEAR);
  small = 0.8 * small;
  small.copyTo(panel(place));
  Placed placed{view.camera, cv::Point2d(place.x, place.y)};
  placed.camera.intrinsics = scaled_to(view.camera.intrinsics, place.width, place.height);
  draw_edges(panel, placed, box);
  const cv::Rect inset(kPanelWidth - kInset - 8, kPanelHeight - kInset - 8, kInset, kInset);
  draw_corners(panel, placed, box, inset);
  draw_inset(panel, view, box, voxel_size, inset);
  const double depth = view.camera.to_camera(box.center()).z;
  panel(cv::Rect(0, 0, kPanelWidth, kTitle)).setTo(kPaper);
  std::string title = concat("camera ", index, ", ", view.name);
  if (depth > 0)
    title += concat("; a voxel of ", number(voxel_size), " is ",
                    number(voxel_size * view.camera.intrinsics.fx / depth),
                    " pixels in the box's middle: the grid");
  put_text(panel, title, {8, kTitle / 2}, 0.5);
  return panel;
}

}  // namespace
}  // namespace picture

RgbImage draw_box(const Scene& scene, std::span<const double> scales, double voxel_size,
                  std::span<const ScenePoint> points) {
  using namespace picture;
  PHOTOHULL_CHECK_OP(scales.size(), ==, scene.views.size());
  PHOTOHULL_CHECK(scene.box.has_value());
  std::vector<cv::Mat> panels;
  for (const std::size_t i : telling_views(scene))
    panels.push_back(draw_photograph(load(scene.views[i], scales[i]), i, *scene.box, voxel_size));
  panels.push_back(draw_plan(scene, points));
  const int rows = int(panels.size() + 1) / 2, head = 2 * kTitle, gap = 6;
  RgbImage out{2 * kPanelWidth + gap, head + rows * (kPanelHeight + gap), {}};
  cv::Mat sheet(out.height, out.width, CV_8UC3, cv::Scalar(60, 60, 60));
  sheet(cv::Rect(0, 0, out.width, head)).setTo(kPaper);
  for (int i = 0; i < int(panels.size()); ++i)
    panels[std::size_t(i)].copyTo(
        sheet(cv::Rect(i % 2 * (kPanelWidth + gap), head + i / 2 * (kPanelHeight + gap),
                       kPanelWidth, kPanelHeight)));
  const Box& b = *scene.box;
  put_text(sheet,
           option_word(
               "box", concat("\"", number(b.min.x), " ", number(b.min.y), " ", number(b.min.z), " ",
                             number(b.max.x), " ", number(b.max.y), " ", number(b.max.z), "\"")),
           {8, 16}, 0.65);
  put_text(sheet, scene.box_source, {8, 44}, 0.5, kDim);
  int x = out.width - 330;
  for (int axis = 0; axis < 3; ++axis, x += 110)
    put_text(sheet, concat("xyz"[axis], " edges"), {x, 16}, 0.6, kAxis[axis]);
  cv::Mat rgb;
  cv::cvtColor(sheet, rgb, cv::COLOR_BGR2RGB);
  out.rgb.assign(rgb.datastart, rgb.dataend);
  return out;
}

}  // namespace photohull::pipeline

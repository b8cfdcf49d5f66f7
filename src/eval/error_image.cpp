#include "eval/error_image.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "core/box.h"
#include "core/error.h"
#include "core/image.h"
#include "eval/error_mesh.h"
#include "eval/topology.h"
#include "raycast/ray_scene.h"

namespace photohull::eval {
namespace {

constexpr int kFine = 2;  ///< rays along a pixel's edge
constexpr int kTitleHeight = 40, kLegendHeight = 90;
const glm::dvec3 kBackground(38);

/// A parallel projection; the frame is right-handed with `right` x `up` = `back`.
struct Viewpoint {
  const char* name;
  glm::dvec3 back;  ///< towards the viewer
  glm::dvec3 up;
};

const std::array<Viewpoint, 6> kViewpoints = {{{"from +x", {1, 0, 0}, {0, 0, 1}},
                                               {"from +y", {0, 1, 0}, {0, 0, 1}},
                                               {"from +z", {0, 0, 1}, {0, 1, 0}},
                                               {"from -x", {-1, 0, 0}, {0, 0, 1}},
                                               {"from -y", {0, -1, 0}, {0, 0, 1}},
                                               {"from -z", {0, 0, -1}, {0, 1, 0}}}};

Box bounds_of(const TriMesh& mesh) {
  Box box{glm::dvec3(INFINITY), glm::dvec3(-INFINITY)};
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    box.min = glm::min(box.min, mesh.world(i));
    box.max = glm::max(box.max, mesh.world(i));
  }
  return box;
}

/// What the panels share.
struct Stage {
  const TriMesh& result;
  const Truth& truth;
  RayScene rays;
  glm::dvec3 centre;
  double reach;  ///< rays start so far in front of the centre
  double frame;  ///< world units along a panel's edge
  double range;
};

std::uint8_t encode(double linear) {
  return std::uint8_t(std::lround(255 * srgb_from_linear(std::clamp(linear, 0.0, 1.0))));
}

/// 8-bit sRGB to linear light.
glm::dvec3 decode(const glm::dvec3& code) {
  return {linear_from_srgb(code.r / 255), linear_from_srgb(code.g / 255),
          linear_from_srgb(code.b / 255)};
}

/// Linear light of a pixel from the hits of its rays: the distance is asked for once, at the first
/// hit; light and coverage are the rays' own.
glm::dvec3 shade(const Stage& stage, const Ray* rays, const Hit* hits) {
  const Hit* end = hits + kFine * kFine;
  const Hit* first = std::find_if(hits, end, [](const Hit& hit) { return bool(hit); });
  if (first == end) return decode(kBackground);
  const Ray& ray = rays[first - hits];
  const glm::dvec3 p = ray.origin + first->t * ray.direction;
  const glm::dvec3 colour = decode(error_colour(stage.truth.surface().at(p).distance, stage.range));
  glm::dvec3 sum(0);
  for (const Hit* hit = hits; hit != end; ++hit) {
    if (!*hit) {
      sum += decode(kBackground);
      continue;
    }
    const glm::dvec3 normal = area_vector(stage.result, hit->triangle);
    const double length = glm::length(normal);
    const double facing = length > 0 ? std::abs(glm::dot(normal, ray.direction)) / length : 0;
    sum += (0.25 + 0.75 * facing) * colour;
  }
  return sum / double(kFine * kFine);
}

void draw_row(const Stage& stage, const Viewpoint& view, int y, cv::Mat panel) {
  const glm::dvec3 right = glm::cross(view.up, view.back);
  const int edge = kFine * panel.cols;
  std::vector<Ray> rays;
  for (int x = 0; x < panel.cols; ++x)
    for (int i = 0; i < kFine * kFine; ++i) {
      const double u = (kFine * x + i % kFine + 0.5) / edge - 0.5;
      const double v = 0.5 - (kFine * y + i / kFine + 0.5) / edge;
      rays.push_back(
          {stage.centre + stage.frame * (u * right + v * view.up) + stage.reach * view.back,
           -view.back, 0, INFINITY});
    }
  std::vector<Hit> hits(rays.size());
  stage.rays.closest(rays, hits);
  for (int x = 0; x < panel.cols; ++x) {
    const std::size_t first = std::size_t(x) * kFine * kFine;
    const glm::dvec3 light = shade(stage, &rays[first], &hits[first]);
    for (int c = 0; c < 3; ++c) panel.at<cv::Vec3b>(y, x)[c] = encode(light[c]);
  }
}

enum class Align { kLeft, kCentre, kRight };

void draw_text(cv::Mat& image, const std::string& text, int x, int baseline, Align align) {
  constexpr double kScale = 0.5;
  int below = 0;
  const int width = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kScale, 1, &below).width;
  if (align == Align::kCentre) x -= width / 2;
  if (align == Align::kRight) x -= width;
  cv::putText(image, text, {x, baseline}, cv::FONT_HERSHEY_SIMPLEX, kScale,
              cv::Scalar(235, 235, 235), 1, cv::LINE_AA);
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%+.3g", value);
  return value == 0 ? "0" : text;
}

/// A bar of all colours, with distances in world units and in percent of the diagonal.
void draw_legend(cv::Mat& image, int top, double range, double diagonal) {
  const int left = image.cols / 5, width = image.cols - 2 * left;
  for (int x = 0; x < width; ++x) {
    const glm::dvec3 c = error_colour(range * (2.0 * x / (width - 1) - 1), range);
    cv::line(image, {left + x, top + 24}, {left + x, top + 44}, cv::Scalar(c.r, c.g, c.b));
  }
  for (int i = -2; i <= 2; ++i) {
    const double distance = range * i / 2;
    const int x = left + (i + 2) * (width - 1) / 4;
    cv::line(image, {x, top + 44}, {x, top + 50}, cv::Scalar(235, 235, 235));
    draw_text(image, number(distance), x, top + 66, Align::kCentre);
    draw_text(image, number(100 * distance / diagonal) + " %", x, top + 83, Align::kCentre);
  }
  draw_text(image, "inside the truth", left, top + 16, Align::kLeft);
  draw_text(image, "outside the truth", left + width, top + 16, Align::kRight);
  draw_text(image, "world units", left - 60, top + 66, Align::kRight);
  draw_text(image, "of the diagonal", left - 60, top + 83, Align::kRight);
}

}  // namespace

RgbImage draw_error_image(const TriMesh& result, const Truth& truth,
                          const ErrorImageOptions& options, Progress& progress) {
  PHOTOHULL_CHECK(options.range > 0 && options.panel >= 64 && options.panel <= 4096);
  const Box box = bounds_of(truth.mesh()), all = bounds_of(result);
  const glm::dvec3 size = box.size();
  const double frame = 1.12 * std::max({size.x, size.y, size.z});
  const double reach = glm::length(all.center() - box.center()) + all.diagonal() + box.diagonal();
  const Stage stage{result, truth, RayScene(result), box.center(), reach, frame, options.range};
  cv::Mat image(kTitleHeight + 2 * options.panel + kLegendHeight, 3 * options.panel, CV_8UC3,
                cv::Scalar(kBackground.r, kBackground.g, kBackground.b));
  for (int i = 0; i < 6; ++i) {
    progress.check_cancelled();
    progress.update(i / 6.0);
    const cv::Rect area((i % 3) * options.panel, kTitleHeight + (i / 3) * options.panel,
                        options.panel, options.panel);
    const cv::Mat panel = image(area);
    tbb::parallel_for(0, panel.rows, [&](int y) { draw_row(stage, kViewpoints[i], y, panel); });
    draw_text(image, kViewpoints[i].name, area.x + 12, area.y + 18, Align::kLeft);
  }
  draw_text(image, options.title, 12, 26, Align::kLeft);
  draw_legend(image, kTitleHeight + 2 * options.panel, options.range, truth.diagonal());
  return {image.cols, image.rows,
          std::vector<std::uint8_t>(image.data, image.data + image.total() * 3)};
}

}  // namespace photohull::eval

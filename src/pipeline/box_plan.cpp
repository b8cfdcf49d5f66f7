// Cameras and box seen from above.
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "pipeline/box_picture_parts.h"

namespace photohull::pipeline::picture {
namespace {

constexpr int kBorder = 55;     // pixels around the drawing: numbers stand there
constexpr double kShown = 4;    // half diagonals of the box: cameras farther off are not shown
constexpr double kCamera = 22;  // pixels
constexpr int kMostNamed = 24;  // cameras with their numbers

/// The plan's axes in the world: right, up the paper, and towards the eye.
struct Directions {
  int right = 0, up = 1, eye = 2;  // axes
  bool from_below = false;         // the eye's side is the axis' negative one
  bool flipped = false;            // right is the axis' negative direction
};

Directions directions(const Scene& scene) {
  glm::dvec3 sky(0.0);  // where the photographs' upper edges are
  for (const SourceView& v : scene.views)
    sky -= glm::transpose(v.camera.cam_from_world.rotation) * glm::dvec3(0, 1, 0);
  Directions d;
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(sky[axis]) > std::abs(sky[d.eye])) d.eye = axis;
  d.right = (d.eye + 1) % 3, d.up = (d.eye + 2) % 3;
  d.from_below = d.flipped = sky[d.eye] < 0;
  return d;
}

/// From world to paper.
class Paper {
 public:
  Paper(const Directions& d, const glm::dvec2& low, const glm::dvec2& high) : d_(d) {
    const glm::dvec2 room(kPanelWidth - 2 * kBorder, kPanelHeight - kTitle - 2 * kBorder);
    scale_ = std::min(room.x / (high.x - low.x), room.y / (high.y - low.y));
    middle_ = 0.5 * (low + high);
  }
  /// World coordinates along the plan's axes.
  static glm::dvec2 along(const Directions& d, const glm::dvec3& world) {
    return {world[d.right], world[d.up]};
  }
  cv::Point2d at(const glm::dvec2& p) const {
    const glm::dvec2 q = scale_ * (p - middle_);
    return {0.5 * kPanelWidth + (d_.flipped ? -q.x : q.x),
            kTitle + 0.5 * (kPanelHeight - kTitle) - q.y};
  }
  cv::Point2d at(const glm::dvec3& world) const { return at(along(d_, world)); }
  double scale() const { return scale_; }
  glm::dvec2 low() const {
    return middle_ - 0.5 * glm::dvec2(kPanelWidth, kPanelHeight - kTitle) / scale_;
  }
  glm::dvec2 high() const {
    return middle_ + 0.5 * glm::dvec2(kPanelWidth, kPanelHeight - kTitle) / scale_;
  }

 private:
  Directions d_;
  glm::dvec2 middle_{0.0};
  double scale_ = 1;
};

/// 1, 2 or 5 times a power of ten, about a tenth of the extent.
double tick_step(double extent) {
  const double power = std::pow(10, std::floor(std::log10(extent / 10)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (extent / (factor * power) <= 12) return factor * power;
  return 10 * power;
}

void draw_rulers(cv::Mat& plan, const Paper& paper, const Directions& d) {
  for (int k = 0; k < 2; ++k) {
    const int axis = k == 0 ? d.right : d.up;
    const double low = paper.low()[k], high = paper.high()[k];
    const double step = tick_step(high - low);
    for (double i = std::ceil(low / step); i * step < high; ++i) {
      const cv::Point2d p =
          k == 0 ? paper.at({i * step, paper.low().y}) : paper.at({paper.low().x, i * step});
      const cv::Scalar faint = kPaper + cv::Scalar(28, 28, 28);
      if (k == 0) {
        cv::line(plan, {int(p.x), kTitle}, {int(p.x), kPanelHeight}, faint, 1);
        put_text(plan, number(i * step), {int(p.x) - 12, kPanelHeight - 12}, 0.42, kAxis[axis]);
      } else {
        cv::line(plan, {0, int(p.y)}, {kPanelWidth, int(p.y)}, faint, 1);
        put_text(plan, number(i * step), {2, int(p.y)}, 0.42, kAxis[axis]);
      }
    }
  }
}

void draw_camera(cv::Mat& plan, const Paper& paper, const Directions& d, const Camera& camera) {
  const cv::Point2d at = paper.at(camera.center());
  const Intrinsics& k = camera.intrinsics;
  std::vector<cv::Point> shape{at};
  for (const double x : {-0.5, k.width - 0.5}) {
    const glm::dvec3 ray = camera.ray({x, 0.5 * (k.height - 1)});
    glm::dvec2 along = Paper::along(d, ray);
    if (d.flipped) along.x = -along.x;
    shape.push_back(at + kCamera * cv::Point2d(along.x, -along.y));
  }
  cv::polylines(plan, shape, true, kInk, 1, cv::LINE_AA);
  cv::circle(plan, at, 3, kInk, cv::FILLED, cv::LINE_AA);
}

}  // namespace

cv::Mat draw_plan(const Scene& scene, std::span<const ScenePoint> points) {
  const Box& box = *scene.box;
  const Directions d = directions(scene);
  glm::dvec2 low = Paper::along(d, box.min), high = Paper::along(d, box.max);
  int far_off = 0;
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    const glm::dvec3 c = scene.views[i].camera.center();
    if (glm::distance(c, box.center()) > kShown * box.diagonal()) {
      ++far_off;
      continue;
    }
    shown.push_back(i);
    low = glm::min(low, Paper::along(d, c)), high = glm::max(high, Paper::along(d, c));
  }
  const Paper paper(d, low, high);
  cv::Mat plan(kPanelHeight, kPanelWidth, CV_8UC3, kPaper);
  draw_rulers(plan, paper, d);
  for (const ScenePoint& p : points)
    cv::circle(plan, paper.at(p.position), 1, kDim, cv::FILLED, cv::LINE_AA);
  cv::rectangle(plan, cv::Rect2d(paper.at(box.min), paper.at(box.max)), kBoxEdge, 2, cv::LINE_AA);
  for (const std::size_t i : shown) {
    draw_camera(plan, paper, d, scene.views[i].camera);
    if (shown.size() <= kMostNamed) {
      const cv::Point2d at = paper.at(scene.views[i].camera.center());
      put_text(plan, concat(i), {int(at.x) + 6, int(at.y) - 9}, 0.4, kDim);
    }
  }
  const char* names = "xyz";
  const auto sides = [&](int axis) {
    return concat(names[axis], " ", number(box.min[axis]), " to ", number(box.max[axis]));
  };
  const cv::Point2d middle = paper.at(box.center());
  const cv::Point2d edge = paper.at({box.center()[d.right], box.min[d.up]});
  put_text(plan, sides(d.right), {int(edge.x) - 50, int(edge.y) + 14}, 0.45, kAxis[d.right]);
  put_text(plan, sides(d.up),
           {int(std::max(paper.at(box.min).x, paper.at(box.max).x)) + 6, int(middle.y)}, 0.45,
           kAxis[d.up]);
  plan(cv::Rect(0, 0, kPanelWidth, kTitle)).setTo(kPaper);
  put_text(
      plan,
      concat("from above (against ", d.from_below ? "-" : "+", names[d.eye], "): ", shown.size(),
             " cameras", far_off ? concat(", ", far_off, " too far off to show") : std::string(),
             "; the box has ", sides(d.eye)),
      {8, kTitle / 2}, 0.5);
  return plan;
}

}  // namespace photohull::pipeline::picture

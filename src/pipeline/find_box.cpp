#include "pipeline/find_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>

#include "carving/object_box.h"
#include "core/error.h"
#include "core/median.h"
#include "core/option_word.h"

namespace photohull::pipeline {
namespace {

// Constants without a reason of their own were chosen on the scenes of docs/guide/box.md, which
// tells what other values give there.
constexpr std::size_t kEnough = 100;  // points that tell alone
constexpr std::size_t kFewest = 20;   // points that tell anything
constexpr double kAllAround = 120;    // degrees between two axes: what is behind the object for
                                      // one camera is behind the other one itself
constexpr double kShareAround = 1 / 2.0, kShareAhead = 1 / 3.0;  // of the best-seen point's cameras
constexpr double kLink = 0.07;         // of the distance from the cameras: gaps within a surface
constexpr double kPart = 0.1;          // of the heaviest part's weight: a part of the object, too
constexpr double kTrim = 0.005;        // of the weight on each side: false matches
constexpr double kMargin = 0.1;        // of a side: features end before the surface does
constexpr double kLeastMargin = 0.03;  // of the diagonal, for flat things
constexpr double kClearance = 0.01;    // of the diagonal, from a camera
constexpr double kCutWarning = 0.05;   // of the weight, cut off
constexpr double kMeets = 0.2;         // of the distance: axes pass their meeting point
constexpr double kNearlyAll = 0.9;     // of the cameras
constexpr double kMostMeeting = 0.5;   // of a room's cameras
constexpr double kSmallestTurn = 10;   // degrees: axes that differ less meet nowhere for sure
constexpr double kDegrees = 180 / std::numbers::pi;

/// The point nearest to lines, and nothing where they are as good as parallel.
std::optional<glm::dvec3> nearest_to_lines(const std::vector<glm::dvec3>& through,
                                           const std::vector<glm::dvec3>& along) {
  glm::dmat3 normal(0.0);
  glm::dvec3 right(0.0);
  for (std::size_t i = 0; i < through.size(); ++i) {
    const glm::dmat3 across = glm::dmat3(1.0) - glm::outerProduct(along[i], along[i]);
    normal += across;
    right += across * through[i];
  }
  const double n = double(through.size());
  if (!(glm::determinant(normal) > 1e-6 * n * n * n)) return std::nullopt;
  return glm::inverse(normal) * right;
}

std::vector<Camera> cameras_of(std::span<const PreparedView> views) {
  std::vector<Camera> cameras;
  for (const PreparedView& view : views) cameras.push_back(view.camera);
  return cameras;
}

// ---- silhouettes

struct Foreground {
  glm::dvec2 middle{0.0};   ///< pixels
  bool ends_within = true;  ///< it touches the frame nowhere, or hardly
};

std::optional<Foreground> foreground_of(const Mask& mask) {
  constexpr double kTouching = 0.05;  // of the frame's pixels: a stand, a thread
  Foreground found;
  double count = 0, border = 0;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      if (mask.coverage[std::size_t(y) * mask.width + x] >= 128) {
        found.middle += glm::dvec2(x, y);
        ++count;
        border += x == 0 || y == 0 || x == mask.width - 1 || y == mask.height - 1;
      }
  if (count == 0) return std::nullopt;
  found.middle /= count;
  found.ends_within = border < kTouching * 2 * (mask.width + mask.height);
  return found;
}

std::optional<FoundBox> box_of_silhouettes(std::span<const PreparedView> views) {
  std::vector<glm::dvec3> through, along;
  std::size_t masked = 0, bounded = 0;
  for (const PreparedView& view : views) {
    if (view.mask.empty()) continue;
    const auto foreground = foreground_of(view.mask);
    if (!foreground) continue;
    ++masked;
    bounded += foreground->ends_within;
    through.push_back(view.camera.center());
    along.push_back(view.camera.ray(foreground->middle));
  }
  if (masked < 2 || 2 * bounded < masked) return std::nullopt;
  const auto middle = nearest_to_lines(through, along);
  if (!middle) return std::nullopt;
  std::vector<double> distances;
  for (const glm::dvec3& camera : through) distances.push_back(glm::distance(camera, *middle));
  const double reach = median(distances);  // the object is before the cameras
  const Box cube{*middle - reach, *middle + reach};
  const Box box = carving::object_box(cube, views);
  if (box.min == cube.min && box.max == cube.max) return std::nullopt;  // nothing was left of it
  return FoundBox{
      box, concat("found: the space that the silhouettes of ", masked, " views leave"), {}, {}, {}};
}

// ---- points

struct Weighed {
  ScenePoint point;
  double weight;
};

double weight_of(const ScenePoint& p) { return std::max(1.0, double(p.views.size()) - 1); }

double total(const std::vector<Weighed>& points) {
  return std::accumulate(points.begin(), points.end(), 0.0,
                         [](double sum, const Weighed& p) { return sum + p.weight; });
}

/// Only the points that enough cameras have on their images.
void keep_looked_at(std::span<const Camera> cameras, double share, std::vector<Weighed>& points) {
  std::vector<std::size_t> seen;
  for (const Weighed& p : points)
    seen.push_back(std::size_t(std::count_if(cameras.begin(), cameras.end(), [&](const Camera& c) {
      const auto pixel = c.project(p.point.position);
      return pixel && c.on_image(*pixel);
    })));
  if (seen.empty()) return;
  const double least = std::max(2.0, share * double(*std::max_element(seen.begin(), seen.end())));
  std::size_t i = 0;
  std::erase_if(points, [&](const Weighed&) { return double(seen[i++]) < least; });
}

/// Distance of a point from the nearest camera that shows it.
double camera_distance(std::span<const Camera> cameras, const ScenePoint& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const int v : p.views)
    least = std::min(least, glm::distance(cameras[std::size_t(v)].center(), p.position));
  if (p.views.empty())
    for (const Camera& c : cameras) least = std::min(least, glm::distance(c.center(), p.position));
  return least;
}

/// Only the heavy parts: cells of a lattice that hold points, connected by sides, edges or corners.
void keep_connected(std::span<const Camera> cameras, std::vector<Weighed>& points) {
  std::vector<double> distances;
  for (const Weighed& p : points) distances.push_back(camera_distance(cameras, p.point));
  const double side = kLink * median(distances);
  if (!(side > 0)) return;
  using Cell = std::array<long, 3>;
  const auto cell_of = [side](const glm::dvec3& p) {
    return Cell{std::lround(p.x / side), std::lround(p.y / side), std::lround(p.z / side)};
  };
  std::map<Cell, int> part;  // -1: not reached
  for (const Weighed& p : points) part[cell_of(p.point.position)] = -1;
  int parts = 0;
  for (auto& [start, number] : part) {
    if (number >= 0) continue;
    number = parts;
    for (std::vector<Cell> reached{start}; !reached.empty();) {
      const Cell c = reached.back();
      reached.pop_back();
      for (int i = 0; i < 27; ++i) {
        const auto next = part.find({c[0] + i % 3 - 1, c[1] + i / 3 % 3 - 1, c[2] + i / 9 - 1});
        if (next == part.end() || next->second >= 0) continue;
        next->second = parts;
        reached.push_back(next->first);
      }
    }
    ++parts;
  }
  std::vector<double> weights(std::size_t(parts), 0.0);
  for (const Weighed& p : points) weights[std::size_t(part[cell_of(p.point.position)])] += p.weight;
  const double least = kPart * *std::max_element(weights.begin(), weights.end());
  std::erase_if(points, [&](const Weighed& p) {
    return weights[std::size_t(part[cell_of(p.point.position)])] < least;
  });
}

/// All but kTrim of the weight on each side, and a margin.
Box box_around(const std::vector<Weighed>& points) {
  const double trimmed = kTrim * total(points);
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<std::pair<double, double>> values;
    for (const Weighed& p : points) values.emplace_back(p.point.position[axis], p.weight);
    std::sort(values.begin(), values.end());
    double below = 0, above = 0;
    auto low = values.begin();
    auto high = values.rbegin();
    while ((below += low->second) <= trimmed) ++low;
    while ((above += high->second) <= trimmed) ++high;
    box.min[axis] = low->first, box.max[axis] = high->first;
  }
  const glm::dvec3 margin =
      glm::max(kMargin * box.size(), glm::dvec3(kLeastMargin * box.diagonal()));
  return {box.min - margin, box.max + margin};
}

double weight_within(const Box& box, const std::vector<Weighed>& points) {
  double sum = 0;
  for (const Weighed& p : points)
    if (box.contains(p.point.position)) sum += p.weight;
  return sum;
}

/// The best of the six boxes that a side drawn in past all `inside` leaves.
Box best_cut(const Box& box, const std::vector<glm::dvec3>& inside,
             const std::vector<Weighed>& points) {
  const double clearance = kClearance * box.diagonal();
  Box best = box;
  double most = -1;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool upper : {false, true}) {
      Box cut = box;
      for (const glm::dvec3& c : inside)
        if (upper)
          cut.max[axis] = std::min(cut.max[axis], c[axis] - clearance);
        else
          cut.min[axis] = std::max(cut.min[axis], c[axis] + clearance);
      if (!(cut.min[axis] < cut.max[axis])) continue;
      const double kept = weight_within(cut, points);
      if (kept > most) most = kept, best = cut;
    }
  return best;
}

/// The box without cameras: its sides drawn in past one after the other where each costs least, or
/// one side past all of them at once, whichever keeps more.
Box without_cameras(const Box& box, std::span<const Camera> cameras,
                    const std::vector<Weighed>& points) {
  std::vector<glm::dvec3> inside;
  for (const Camera& c : cameras)
    if (box.contains(c.center())) inside.push_back(c.center());
  if (inside.empty()) return box;
  const Box at_once = best_cut(box, inside, points);
  Box one_by_one = box;
  for (const glm::dvec3& c : inside)
    if (one_by_one.contains(c)) one_by_one = best_cut(one_by_one, {c}, points);
  return weight_within(one_by_one, points) > weight_within(at_once, points) ? one_by_one : at_once;
}

/// Do the cameras stand in what is around them, and look at it on all sides?
bool is_room(const Box& seen, std::span<const Camera> cameras, const AxesMeeting& axes) {
  const auto within = std::count_if(cameras.begin(), cameras.end(),
                                    [&](const Camera& c) { return seen.contains(c.center()); });
  const double n = double(cameras.size());
  return axes.turn > kAllAround && double(within) >= kNearlyAll * n &&
         double(axes.meeting) <= kMostMeeting * n;
}

FoundBox room(const Box& seen, std::span<const Camera> cameras, const char* what,
              const std::vector<Weighed>& points) {
  FoundBox found{seen, {}, {}, {}, seen};
  for (const Weighed& p : points)
    if (seen.contains(p.point.position)) found.points.push_back(p.point);
  found.source = concat("found: ", points.size(), " ", what, " around ", cameras.size(),
                        " cameras that stand among them, as in a room");
  return found;
}

std::optional<FoundBox> box_of_points(std::span<const Camera> cameras,
                                      const std::vector<ScenePoint>& given, const char* what) {
  std::vector<Weighed> points;
  for (const ScenePoint& p : given) points.push_back({p, weight_of(p)});
  if (points.size() < kFewest) return std::nullopt;
  const Box seen = box_around(points);
  const AxesMeeting axes = meeting_of_axes(cameras);
  if (is_room(seen, cameras, axes)) return room(seen, cameras, what, points);
  keep_looked_at(cameras, axes.turn > kAllAround ? kShareAround : kShareAhead, points);
  if (axes.looks_inwards)
    std::erase_if(points, [&](const Weighed& p) {
      return glm::distance(p.point.position, axes.point) > axes.distance;
    });
  if (points.size() < kFewest) return std::nullopt;
  keep_connected(cameras, points);
  const Box around = box_around(points);
  FoundBox found{without_cameras(around, cameras, points), {}, {}, {}, seen};
  if (const glm::dvec3 s = found.box.size(); !(std::min({s.x, s.y, s.z}) > 0)) return std::nullopt;
  const double lost =
      1 - weight_within(found.box, points) / std::max(weight_within(around, points), 1e-300);
  if (lost > kCutWarning)
    found.warnings.push_back(concat("cameras stand among what they show: the box found leaves out ",
                                    std::lround(100 * lost), " % of it; look at it (",
                                    command_word("info", "picture"), ") and give ",
                                    option_word("box"), " where another part is wanted"));
  for (const Weighed& p : points)
    if (found.box.contains(p.point.position)) found.points.push_back(p.point);
  found.source = concat("found: ", given.size(), " ", what, ", ", found.points.size(),
                        " of them where ", cameras.size(), " cameras ",
                        axes.looks_inwards ? "look at one place" : "look at the same");
  return found;
}

[[noreturn]] void explain_nothing_found(std::span<const Camera> cameras, std::size_t points,
                                        bool masks) {
  const AxesMeeting axes = meeting_of_axes(cameras);
  if (2 * axes.in_front < cameras.size())
    throw Error(concat(
        "no box can be found: the cameras look away from each other (the point "
        "nearest to their optical axes is behind ",
        cameras.size() - axes.in_front, " of ", cameras.size(),
        " cameras); check whether the poses are world-to-camera (", command_word("info", "cameras"),
        "), or give ", option_word("box", "\"x0 y0 z0 x1 y1 z1\"")));
  throw Error(concat("no box can be found: ", points,
                     " features match between the photographs under these cameras (at least ",
                     kFewest, " are needed), and ",
                     masks ? "the masks bound no common space" : "there are no masks", "; give ",
                     option_word("box", "\"x0 y0 z0 x1 y1 z1\""),
                     " or masks, or check the cameras (", command_word("info", "cameras"), ")"));
}

Box around_both(const Box& a, const Box& b) {
  return {glm::min(a.min, b.min), glm::max(a.max, b.max)};
}

}  // namespace

AxesMeeting meeting_of_axes(std::span<const Camera> cameras) {
  AxesMeeting out;
  std::vector<glm::dvec3> through, along;
  for (const Camera& c : cameras) {
    through.push_back(c.center());
    along.push_back(c.forward());
  }
  for (const glm::dvec3& a : along)
    for (const glm::dvec3& b : along)
      out.turn = std::max(out.turn, kDegrees * std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)));
  const auto point = nearest_to_lines(through, along);
  if (!point) {
    out.in_front = cameras.size();  // parallel: they meet far away
    return out;
  }
  out.point = *point;
  std::vector<double> distances;
  for (const glm::dvec3& c : through) distances.push_back(glm::distance(c, out.point));
  out.distance = median(distances);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const glm::dvec3 to = out.point - through[i];
    const double ahead = glm::dot(to, along[i]);
    out.in_front += ahead > 0;
    out.meeting += ahead > 0 && glm::length(to - ahead * along[i]) < kMeets * out.distance;
  }
  out.looks_inwards =
      out.turn > kSmallestTurn && double(out.meeting) >= kNearlyAll * double(cameras.size());
  return out;
}

FoundBox find_box(const BoxEvidence& evidence, Progress& progress) {
  if (evidence.views.size() < 2)
    throw Error(concat("a box is found from two cameras or more, but there ",
                       evidence.views.size() == 1 ? "is 1" : "are 0", "; give ",
                       option_word("box")));
  const std::vector<Camera> cameras = cameras_of(evidence.views);
  const bool masks = std::any_of(evidence.views.begin(), evidence.views.end(),
                                 [](const PreparedView& v) { return !v.mask.empty(); });
  if (masks && evidence.given_masks)
    if (auto found = box_of_silhouettes(evidence.views)) return *found;
  const bool listed = evidence.points.size() >= kEnough;
  const std::vector<ScenePoint> points =
      listed ? evidence.points : find_scene_points(evidence.views, progress);
  auto found =
      box_of_points(cameras, points, listed ? "points of the scene file" : "features triangulated");
  if (masks && !evidence.given_masks && points.size() < kEnough)
    if (auto hull = box_of_silhouettes(evidence.views)) {
      if (found) hull->box = around_both(hull->box, found->box);
      return *hull;
    }
  if (!found) explain_nothing_found(cameras, points.size(), masks);
  return *found;
}

}  // namespace photohull::pipeline

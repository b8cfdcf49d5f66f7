#include "cameras/join_passes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "cameras/feature_tracks.h"
#include "cameras/pass_points.h"
#include "cameras/refine_motion.h"
#include "core/error.h"

namespace photohull {
namespace {

constexpr std::size_t kFewestViews = 3;    // of a pass
constexpr std::size_t kFewestPoints = 30;  // of a pass
constexpr std::size_t kFewestPairs = 12;   // that agree on a motion
constexpr std::size_t kFewestTracks = 20;  // across the seam
constexpr double kLargestDeviation = 1;    // pixels, of the surface across the seam
constexpr double kLargestOutside = 0.1;    // share of the points
constexpr double kFarMoved = 2;            // pixels from the motion that tracks were looked for by
constexpr double kDegree = std::numbers::pi / 180;

constexpr const char* kOverlap =
    "both passes must show part of the surface in common: lay the object on its side rather than "
    "upside down, and photograph it from lower heights, too";

/// Pairs of views across the seam that look at the object from about the same side, and of views
/// beside each of them, ascending.
std::vector<std::pair<int, int>> pairs_across(std::span<const Camera> cameras, std::size_t seam,
                                              const glm::dvec3& middle) {
  constexpr double kLargestAngle = 50;  // degrees
  constexpr std::size_t kAcross = 4, kBeside = 3;
  const double least = std::cos(kLargestAngle * kDegree);
  std::vector<glm::dvec3> out;
  for (const Camera& camera : cameras) out.push_back(glm::normalize(camera.center() - middle));
  const auto nearest = [&](std::size_t i, bool across) {
    std::vector<std::pair<double, int>> others;
    for (std::size_t j = 0; j < out.size(); ++j) {
      const double cosine = glm::dot(out[i], out[j]);
      if (j != i && ((i < seam) != (j < seam)) == across && cosine > least)
        others.emplace_back(-cosine, int(j));
    }
    std::sort(others.begin(), others.end());
    others.resize(std::min(others.size(), across ? kAcross : kBeside));
    return others;
  };
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto across = nearest(i, true);
    if (across.empty()) continue;
    for (const auto& list : {across, nearest(i, false)})
      for (const auto& other : list) pairs.emplace_back(std::minmax(int(i), other.second));
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

glm::dvec3 mean_of(const std::vector<glm::dvec3>& places) {
  glm::dvec3 sum(0.0);
  for (const glm::dvec3& p : places) sum += p;
  return sum / double(std::max<std::size_t>(1, places.size()));
}

/// Does the mask show something within three pixels? Where it has no pixels nothing is known.
bool leaves_out(const PreparedView& view, const Camera& camera, const glm::dvec3& place) {
  constexpr int kReach = 3;
  if (view.mask.empty()) return false;
  const auto pixel = camera.project(place);
  if (!pixel || !camera.on_image(*pixel)) return false;
  const int x = int(std::lround(pixel->x)), y = int(std::lround(pixel->y));
  for (int v = std::max(0, y - kReach); v <= std::min(view.mask.height - 1, y + kReach); ++v)
    for (int u = std::max(0, x - kReach); u <= std::min(view.mask.width - 1, x + kReach); ++u)
      if (view.mask.coverage[std::size_t(v) * std::size_t(view.mask.width) + std::size_t(u)] > 0)
        return false;
  return true;
}

class Joiner {
 public:
  Joiner(std::span<const PhotoPass> passes, Progress& progress)
      : passes_(passes), progress_(progress), result_(passes.size()) {}

  std::vector<JoinedPass> run() {
    find_points();
    joined_.add(points_[0], {});
    order_ = {0};
    while (order_.size() < passes_.size()) {
      const std::size_t before = order_.size();
      std::string why;
      for (std::size_t i = 1; i < passes_.size(); ++i) {
        if (std::find(order_.begin(), order_.end(), i) != order_.end()) continue;
        const std::string failure = join(i);
        if (why.empty()) why = failure;
        if (!failure.empty()) continue;
        order_.push_back(i);
        joined_.add(points_[i], result_[i].motion);
        progress_.update(0.4 + 0.6 * double(order_.size() - 1) / double(passes_.size() - 1));
      }
      if (order_.size() == before) throw Error(why);
    }
    return result_;
  }

 private:
  void find_points() {
    for (const PhotoPass& pass : passes_)
      if (pass.views.size() < kFewestViews)
        throw Error(concat(pass.name, ": ", pass.views.size(),
                           pass.views.size() == 1 ? " photograph has" : " photographs have",
                           " a pose and a mask, and joining passes takes ", kFewestViews,
                           " or more, from all around the object"));
    for (std::size_t i = 0; i < passes_.size(); ++i) {
      points_.push_back(find_described_points(passes_[i].views, passes_[i].box, progress_));
      progress_.update(0.4 * double(i + 1) / double(passes_.size()));
      result_[i].points = int(points_[i].places.size());
      if (points_[i].places.size() < kFewestPoints)
        throw Error(concat(
            passes_[i].name, ": only ", points_[i].places.size(),
            " points of the object can be told apart in its photographs, and joining passes takes ",
            kFewestPoints,
            ": the object has too little texture, is out of focus, or its masks miss it; stick or "
            "draw small marks onto it, on all sides, that stay there in all passes"));
    }
  }

  /// Empty, or why the pass does not fit those that are joined.
  std::string join(std::size_t i) {
    const std::vector<PointPair> pairs = match_points(points_[i], joined_);
    const auto agreed = find_motion(pairs, kFewestPairs);
    if (!agreed)
      return concat(to_others(i), ": of ", pairs.size(), " points that look alike no ",
                    kFewestPairs,
                    ", spread over a part of the surface, agree on one motion. It is another "
                    "object, it changed its form, or ",
                    kOverlap);
    JoinedPass& out = result_[i];
    out.matches = int(agreed->agreeing.size());
    out.motion = agreed->motion;
    return refine(i);
  }

  std::string refine(std::size_t i) {
    JoinedPass& out = result_[i];
    std::vector<PreparedView> views;
    std::vector<Camera> own;  // those that are joined in the first pass's world
    for (const std::size_t j : order_)
      for (const PreparedView& view : passes_[j].views) {
        views.push_back(view);
        views.back().camera = result_[j].motion.moved(view.camera);
        own.push_back(views.back().camera);
      }
    const std::size_t seam = views.size();
    for (const PreparedView& view : passes_[i].views) {
      views.push_back(view);
      own.push_back(view.camera);
    }
    const glm::dvec3 middle = out.motion(mean_of(points_[i].places));
    std::optional<RefinedMotion> refined;
    for (double epipolar : {8.0, 4.0}) {
      const RigidMotion before = out.motion;
      for (std::size_t v = seam; v < views.size(); ++v) views[v].camera = out.motion.moved(own[v]);
      refined = follow(views, own, seam, middle, epipolar, out.motion);
      if (!refined) break;
      out.motion = refined->motion;
      if (moved(i, before, out.motion) < kFarMoved * pixel_size(i)) break;
    }
    if (!refined || refined->points.size() < kFewestTracks)
      return concat(to_others(i), ": ", out.matches, " points fit, but only ",
                    refined ? refined->points.size() : 0, " features are seen well from both, and ",
                    kFewestTracks, " are needed; ", kOverlap);
    tell(i, middle, *refined);
    return judge(i);
  }

  std::optional<RefinedMotion> follow(std::span<const PreparedView> views,
                                      std::span<const Camera> own, std::size_t seam,
                                      const glm::dvec3& middle, double epipolar,
                                      const RigidMotion& start) {
    std::vector<Camera> cameras;
    for (const PreparedView& view : views) cameras.push_back(view.camera);
    TrackOptions options;
    options.features = 2000;
    options.epipolar = epipolar;
    options.pairs = pairs_across(cameras, seam, middle);
    if (options.pairs.empty()) return std::nullopt;
    const std::vector<Track> tracks = find_tracks(views, options, progress_);
    return refine_motion({own, seam, tracks, start, middle});
  }

  void tell(std::size_t i, const glm::dvec3& middle, const RefinedMotion& refined) {
    JoinedPass& out = result_[i];
    out.tracks = int(refined.points.size());
    out.seam = refined.seam;
    for (std::size_t k = 0; k < 3; ++k) {
      out.turn_sigma = std::max(out.turn_sigma, std::sqrt(refined.covariance[k][k]) / kDegree);
      out.move_sigma = std::max(out.move_sigma, std::sqrt(refined.covariance[k + 3][k + 3]));
    }
    double sum = 0;
    for (const glm::dvec3& place : points_[i].places) {
      // Across the line of sight two of the three axes count.
      const double d = deviation_at(refined, middle, out.motion(place));
      sum += 2 * d * d;
    }
    out.seam_sigma = std::sqrt(sum / double(points_[i].places.size())) / pixel_size(i);
    out.outside = std::max(outside(i, joined_.places, out.motion.inverse()), outside_of_joined(i));
  }

  std::string judge(std::size_t i) const {
    const JoinedPass& out = result_[i];
    if (!(out.seam_sigma <= kLargestDeviation))
      return concat(to_others(i), ": ", out.tracks,
                    " features are seen from both, but they lie so close together, or along a "
                    "line, that the surface's place is open",
                    std::isfinite(out.seam_sigma) ? concat(" by ", out.seam_sigma, " pixels") : "",
                    "; ", kOverlap);
    if (out.outside > kLargestOutside)
      return concat(to_others(i), ": some of the surface is the same, but ",
                    int(std::lround(100 * out.outside)),
                    " % of its points lie beside the object in photographs of the other: the "
                    "object changed its form or something moved with it, or masks are wrong; look "
                    "at the masks");
    return "";
  }

  std::string to_others(std::size_t i) const {
    std::string names;
    for (const std::size_t j : order_) names += (names.empty() ? "" : ", ") + passes_[j].name;
    return passes_[i].name + " does not fit " + names;
  }

  /// The share of places, moved to the pass's world, that its masks leave out, over all views.
  double outside(std::size_t pass, const std::vector<glm::dvec3>& places,
                 const RigidMotion& motion) const {
    double out = 0, all = 0;
    for (const PreparedView& view : passes_[pass].views)
      for (const glm::dvec3& place : places)
        out += leaves_out(view, view.camera, motion(place)), ++all;
    return out / std::max(1.0, all);
  }

  double outside_of_joined(std::size_t i) const {
    double largest = 0;
    for (const std::size_t j : order_) {
      std::vector<glm::dvec3> places;
      for (const glm::dvec3& p : points_[i].places) places.push_back(result_[i].motion(p));
      largest = std::max(largest, outside(j, places, result_[j].motion.inverse()));
    }
    return largest;
  }

  /// World units at the object, in the mean over the pass's views.
  double pixel_size(std::size_t pass) const {
    const glm::dvec3 middle = mean_of(points_[pass].places);
    double sum = 0;
    for (const PreparedView& view : passes_[pass].views)
      sum += view.camera.to_camera(middle).z / view.camera.intrinsics.fx;
    return sum / double(passes_[pass].views.size());
  }

  /// World units, root mean square over the pass's points.
  double moved(std::size_t pass, const RigidMotion& before, const RigidMotion& after) const {
    double sum = 0;
    for (const glm::dvec3& p : points_[pass].places) {
      const glm::dvec3 d = before(p) - after(p);
      sum += glm::dot(d, d);
    }
    return std::sqrt(sum / double(points_[pass].places.size()));
  }

  std::span<const PhotoPass> passes_;
  Progress& progress_;
  std::vector<JoinedPass> result_;
  std::vector<DescribedPoints> points_;  ///< of each pass, in its own world
  DescribedPoints joined_;               ///< of all that are joined, in the first one's
  std::vector<std::size_t> order_;       ///< passes that are joined
};

}  // namespace

std::vector<JoinedPass> join_passes(std::span<const PhotoPass> passes, Progress& progress) {
  PHOTOHULL_CHECK_OP(passes.size(), >, 0u);
  return Joiner(passes, progress).run();
}

}  // namespace photohull

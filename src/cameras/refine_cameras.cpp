#include "cameras/refine_cameras.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "cameras/bundle.h"
#include "cameras/frontier.h"
#include "cameras/gauge.h"
#include "cameras/look_at_cameras.h"
#include "cameras/residuals.h"
#include "cameras/surface_patches.h"
#include "core/error.h"
#include "core/median.h"
#include "photo/grey_image.h"

namespace photohull {
namespace {

constexpr int kFewestTracks = 30;            // for the similarity that fixes the gauge
constexpr std::size_t kGaugePoints = 200;    // that fix it, at most
constexpr std::size_t kTrialTracks = 1500;   // that tell whether views share an error
constexpr double kOutlier = 4;               // spreads
constexpr double kLeastSigma = 0.03;         // pixels: nothing is measured better
constexpr double kLeastTangentSigma = 0.15;  // pixels: contours err alike where they touch
constexpr double kUsualError = 1;            // pixels, of given poses
constexpr double kAlike = 1.5;         // times what independent errors of poses leave in their mean
constexpr double kHeldOut = 0.2;       // share of the tracks and tangents that only judge
constexpr double kWorthwhile = 0.999;  // of the cost: what a round must leave for another one
constexpr int kRounds = 8;             // at most; each one finds outliers and tangents anew
constexpr double kMostlyShared = 0.5;  // of the residuals: what they fall below by what is shared
constexpr double kGross = 5;  // pixels: such residuals do not tell poses' errors from shared ones
constexpr double kSearchWidth = 4;  // times what cameras are off in the median
constexpr double kNoWorse = 1.2;    // times the residual without what views share

using Cameras = std::vector<Camera>;

/// Spread evenly over any list, the same every time.
bool is_held_out(std::size_t index) {
  return std::fmod(double(index + 1) * 0.6180339887498949, 1.0) < kHeldOut;
}

/// So many of a list, spread evenly over it.
template <typename T>
std::vector<T> some(const std::vector<T>& list, std::size_t most) {
  const std::size_t step = std::max<std::size_t>(1, (list.size() + most - 1) / most);
  std::vector<T> result;
  for (std::size_t i = 0; i < list.size(); i += step) result.push_back(list[i]);
  return result;
}

class CameraRefiner {
 public:
  /// `given`: what the result is compared with, and held near to; `start`: where it begins.
  CameraRefiner(std::span<const PreparedView> views, Cameras given, Cameras start,
                const RefineCamerasOptions& options, std::vector<Track> tracks, Progress& progress)
      : options_(options),
        progress_(progress),
        given_(std::move(given)),
        start_(std::move(start)),
        outlines_(outlines_of(views)) {
    for (std::size_t i = 0; i < tracks.size(); ++i)
      (is_held_out(i) ? judging_ : adjusting_).push_back(std::move(tracks[i]));
  }

  CameraRefinement run() {
    middle_ = find_middle();
    if (options_.intrinsics != SharedIntrinsics::kWhereAlike) return refine(options_.intrinsics);
    CameraRefinement poses = refine(SharedIntrinsics::kNone);
    const double views = double(given_.size());
    if (!(poses.moved_alike > kAlike * poses.moved / std::sqrt(views))) return poses;
    // Some of the tracks suffice to tell.
    const std::vector<Track> all = std::exchange(adjusting_, some(adjusting_, kTrialTracks));
    CameraRefinement shared = refine(SharedIntrinsics::kAll);
    const bool with_all = adjusting_.size() == all.size();
    adjusting_ = all;
    constexpr double kShared = 3;  // parameters, which spare the poses' motions in the images
    const bool spares =
        4 * views * std::log(poses.moved / shared.moved) > kShared * std::log(2 * views);
    const bool fits = shared.all.after < kNoWorse * poses.all.after &&
                      shared.tangents_after < kNoWorse * poses.tangents_after;
    if (!spares || !fits) return poses;
    return with_all ? shared : refine(SharedIntrinsics::kAll);
  }

 private:
  CameraRefinement refine(SharedIntrinsics intrinsics) {
    Cameras cameras = start_;
    const double given = spread(judge(given_));
    prior_sigma_ = std::max(kUsualError, 2 * given);
    CameraRefinement result;
    // A turn looks almost like an offset of the principal point: while poses are held, the offset
    // is what all views have in common.
    if (intrinsics != SharedIntrinsics::kNone && try_round(cameras, intrinsics, true, result)) {
      // Poses explain what is left; little is, where they were right.
      const double left = spread(judge(cameras));
      const bool right = given < kGross && left < kMostlyShared * given;
      prior_sigma_ = right ? left : 2 * left;
    }
    const bool last = intrinsics != SharedIntrinsics::kAll;
    bool with_intrinsics = false;
    for (int round = 0; round < kRounds; ++round) {
      progress_.check_cancelled();
      progress_.update(0.9 + 0.1 * round / kRounds);
      const auto shared = with_intrinsics ? SharedIntrinsics::kAll : SharedIntrinsics::kNone;
      if (try_round(cameras, shared, false, result)) continue;
      // Poses come first; what all views share follows once they have settled.
      if (with_intrinsics || last) break;
      with_intrinsics = true;
    }
    if (result.changed && options_.held.empty()) cameras = fix_gauge(cameras);
    result.tracks = int(adjusting_.size() + judging_.size());
    report(cameras, result);
    result.cameras = std::move(cameras);
    return result;
  }

  /// One adjustment, taken when what is held out agrees better. False once it has settled.
  bool try_round(Cameras& cameras, SharedIntrinsics intrinsics, bool hold_poses,
                 CameraRefinement& result) const {
    std::array<double, 3> shared;
    const Judgement before = judge(cameras);
    Cameras better = adjust(cameras, intrinsics, hold_poses, shared);
    const Judgement after = judge(better);
    // By the narrower spread: matches that are wrong, which any camera leaves off, do not hide
    // that the others come to agree.
    const double track_sigma = std::min(before.track_sigma, after.track_sigma);
    const double tangent_sigma = std::min(before.tangent_sigma, after.tangent_sigma);
    const double cost = cost_of(after, track_sigma, tangent_sigma);
    const double cost_before = cost_of(before, track_sigma, tangent_sigma);
    if (!(cost < cost_before * (1 - 1e-9))) return false;
    ++result.rounds;
    result.changed = true;
    cameras = std::move(better);
    result.focal_factor *= shared[0];
    result.principal += glm::dvec2(shared[1], shared[2]);
    return cost <= kWorthwhile * cost_before;
  }

  struct Judgement {
    std::vector<double> tracks, tangents;  // pixels
    double track_sigma = 1, tangent_sigma = 1;
  };

  double spread(const Judgement& j) const {
    const bool few = judging_.size() < std::size_t(kFewestTracks);
    return std::max(few ? 0 : j.track_sigma, j.tangent_sigma);
  }

  /// Where the optical axes pass nearest: around there is the object.
  glm::dvec3 find_middle() const {
    glm::dmat3 normal(0.0);
    glm::dvec3 right(0.0);
    for (const Camera& camera : given_) {
      const glm::dvec3 d = camera.forward();
      const glm::dmat3 across = glm::dmat3(1.0) - glm::outerProduct(d, d);
      normal += across;
      right += across * camera.center();
    }
    const double n = double(given_.size());
    if (glm::determinant(normal) > 1e-6 * n * n * n) return glm::inverse(normal) * right;
    std::vector<glm::dvec3> points;
    for (const glm::dvec3& p : triangulate_all(given_, adjusting_).points)
      if (!std::isnan(p.x)) points.push_back(p);
    glm::dvec3 sum(0.0);
    for (const glm::dvec3& p : points) sum += p;
    return points.empty() ? given_[0].center() + given_[0].forward() : sum / double(points.size());
  }

  std::vector<FrontierPair> tangents(const Cameras& cameras, bool held_out) const {
    std::vector<FrontierPair> chosen;
    for (const FrontierPair& pair : frontier_pairs(cameras, outlines_)) {
      // By the pair of views, so that the choice stays when tangents are found anew.
      const std::size_t index = std::size_t(pair.view_a) * given_.size() + std::size_t(pair.view_b);
      if (is_held_out(index) == held_out) chosen.push_back(pair);
    }
    return chosen;
  }

  /// Residuals of what is held out.
  Judgement judge(const Cameras& cameras) const {
    Judgement j{triangulate_all(cameras, judging_).rms,
                tangent_distances(cameras, tangents(cameras, true))};
    j.track_sigma = std::max(kLeastSigma, spread_of_lengths(j.tracks));
    j.tangent_sigma = std::max(kLeastTangentSigma, spread_of_distances(j.tangents));
    return j;
  }

  static double cost_of(const Judgement& j, double track_sigma, double tangent_sigma) {
    const double n = double(j.tracks.size()), m = double(j.tangents.size());
    if (n + m == 0) return 0;
    return (n * robust_cost(j.tracks, track_sigma) + m * robust_cost(j.tangents, tangent_sigma)) /
           (n + m);
  }

  Cameras adjust(const Cameras& cameras, SharedIntrinsics intrinsics, bool hold_poses,
                 std::array<double, 3>& shared) const {
    const Triangulated all = triangulate_all(cameras, adjusting_);
    BundleInput input;
    input.track_sigma = std::max(kLeastSigma, spread_of_lengths(all.rms));
    std::vector<Track> kept;
    for (std::size_t i = 0; i < adjusting_.size(); ++i)
      if (all.rms[i] < kOutlier * 1.5 * input.track_sigma) {
        kept.push_back(adjusting_[i]);
        input.points.push_back(all.points[i]);
      }
    const std::vector<FrontierPair> pairs = tangents(cameras, false);
    input.tangent_sigma =
        std::max(kLeastTangentSigma, spread_of_distances(tangent_distances(cameras, pairs)));
    input.tracks = kept;
    input.tangents = pairs;
    input.intrinsics = intrinsics;
    input.hold_poses = hold_poses;
    input.held = options_.held;
    input.middle = middle_;
    input.prior_sigma = prior_sigma_;  // what neither tracks nor tangents determine stays as given
    return adjust_bundle(input, cameras, given_, shared);
  }

  /// The given poses with the intrinsics of `cameras`: what differs are the poses alone.
  Cameras given_with(const Cameras& cameras) const {
    Cameras result = given_;
    for (std::size_t i = 0; i < result.size(); ++i) result[i].intrinsics = cameras[i].intrinsics;
    return result;
  }

  /// Moved, turned and scaled to where the given poses have the points, or, where there are few,
  /// to the given centres.
  Cameras fix_gauge(const Cameras& cameras) const {
    const Triangulated now = triangulate_all(cameras, adjusting_);
    const double limit = kOutlier * spread_of_lengths(now.rms);
    std::vector<glm::dvec3> points;
    for (std::size_t i = 0; i < adjusting_.size(); ++i)
      if (now.rms[i] < limit) points.push_back(now.points[i]);
    if (points.size() < std::size_t(kFewestTracks)) {
      std::vector<glm::dvec3> from, to;
      for (std::size_t i = 0; i < cameras.size(); ++i) {
        from.push_back(cameras[i].center());
        to.push_back(given_[i].center());
      }
      return with_world_moved(cameras, from, to);
    }
    return with_world_as_given(cameras, given_with(cameras), some(points, kGaugePoints), middle_);
  }

  void report(const Cameras& cameras, CameraRefinement& result) const {
    result.views.resize(cameras.size());
    const Triangulated before = triangulate_all(given_, judging_);
    const Triangulated after = triangulate_all(cameras, judging_);
    const Cameras unmoved = given_with(cameras);
    const double limit = kOutlier * spread_of_lengths(after.rms);
    double moved = 0;
    std::vector<glm::dvec2> moved_by(cameras.size(), glm::dvec2(0.0));
    for (std::size_t i = 0; i < judging_.size(); ++i) {
      if (!(after.rms[i] < limit) || !std::isfinite(before.rms[i])) continue;
      for (const Observation& o : judging_[i].observations) {
        const auto b = given_[o.view].project(before.points[i]),
                   a = cameras[o.view].project(after.points[i]);
        const auto same = unmoved[o.view].project(after.points[i]);
        if (!a || !b || !same) continue;
        for (ViewAgreement* v : {&result.views[o.view], &result.all}) {
          v->before += glm::dot(*b - o.pixel, *b - o.pixel);
          v->after += glm::dot(*a - o.pixel, *a - o.pixel);
          ++v->observations;
        }
        moved += glm::dot(*a - *same, *a - *same);
        moved_by[o.view] += *a - *same;
      }
    }
    result.moved = result.all.observations ? std::sqrt(moved / result.all.observations) : 0;
    glm::dvec2 sum(0.0);
    int known = 0;
    for (std::size_t v = 0; v < cameras.size(); ++v) {
      if (result.views[v].observations == 0) continue;
      sum += moved_by[v] / double(result.views[v].observations);
      ++known;
    }
    result.moved_alike = known ? glm::length(sum) / known : 0;
    for (ViewAgreement& v : result.views) finish(v);
    finish(result.all);
    result.tangents = int(frontier_pairs(cameras, outlines_).size());
    result.tangents_before = median(tangent_distances(given_, tangents(given_, true)));
    result.tangents_after = median(tangent_distances(cameras, tangents(cameras, true)));
  }

  static void finish(ViewAgreement& v) {
    if (v.observations == 0) return;
    v.before = std::sqrt(v.before / v.observations);
    v.after = std::sqrt(v.after / v.observations);
  }

  RefineCamerasOptions options_;
  Progress& progress_;
  Cameras given_, start_;
  std::vector<Outline> outlines_;
  std::vector<Track> adjusting_, judging_;
  glm::dvec3 middle_{0.0};
  double prior_sigma_ = 1;  ///< pixels: how wrong the given poses may well be
};

/// Patches of the surface of the hull that these cameras cut.
std::vector<Track> hull_patches(const Cameras& cameras, std::span<const PreparedView> views,
                                std::span<const GreyImage> images, const Box& box,
                                Progress& progress) {
  constexpr int kCells = 96, kPoints = 4000;
  return patch_tracks(cameras, images, hull_points(cameras, views, box, kCells, kPoints), {},
                      progress);
}

/// Do views have so few observations that patches must help?
bool has_few(std::span<const Track> tracks, std::size_t views, int few) {
  std::vector<double> counts(views, 0);
  for (const Track& track : tracks)
    for (const Observation& o : track.observations) ++counts[std::size_t(o.view)];
  return median(counts) < few;
}

/// Tracks without those that stay where they are in all photographs: where there are no masks, they
/// are of the background before which an object turns.
std::vector<Track> moving(std::span<const PreparedView> views, std::vector<Track> tracks) {
  constexpr double kLeastMotion = 1;  // pixel
  if (std::ranges::any_of(views, [](const PreparedView& v) { return !v.mask.empty(); }))
    return tracks;
  std::erase_if(tracks, [](const Track& track) {
    return std::ranges::all_of(track.observations, [&](const Observation& o) {
      return glm::distance(o.pixel, track.observations.front().pixel) < kLeastMotion;
    });
  });
  return tracks;
}

std::vector<Track> joined(std::vector<Track> a, const std::vector<Track>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

CameraRefinement refine_cameras(std::span<const PreparedView> views,
                                const RefineCamerasOptions& options, Progress& progress) {
  if (views.size() < 3)
    throw Error(
        concat("cameras are refined against each other, which needs three views or more; "
               "there are ",
               views.size()));
  Cameras given;
  for (const PreparedView& view : views) given.push_back(view.camera);
  std::span<const Track> others;
  if (options.source != TrackSource::kFound) others = options.given;
  const auto features_by = [&](const TrackOptions& by) {
    return moving(views,
                  find_tracks(views, by, progress, others, options.source != TrackSource::kGiven));
  };
  TrackOptions tracks = options.tracks;
  tracks.epipolar = std::max(tracks.epipolar, kSearchWidth * pixels_off(views, progress));
  const bool are_far = tracks.epipolar > options.tracks.epipolar;
  std::vector<Track> features = features_by(tracks), patches;
  std::vector<GreyImage> images(views.size());
  const bool with_patches = options.box && has_few(features, views.size(), options.few_features);
  if (with_patches) {
    tbb::parallel_for(std::size_t(0), views.size(),
                      [&](std::size_t i) { images[i] = smoothed(grey_image(views[i].image)); });
    patches = hull_patches(given, views, images, *options.box, progress);
  }
  const auto refine_from = [&](const Cameras& start, const std::vector<Track>& patches_there) {
    return CameraRefiner(views, given, start, options, joined(features, patches_there), progress)
        .run();
  };
  CameraRefinement result = refine_from(given, patches);
  if (result.changed && (with_patches || are_far)) {
    // Near better cameras fewer matches are wrong, and the hull that they cut has patches in more
    // places.
    if (are_far) {
      tracks = options.tracks;
      tracks.cameras = result.cameras;
      features = features_by(tracks);
    }
    const std::vector<Track> again =
        with_patches ? hull_patches(result.cameras, views, images, *options.box, progress)
                     : patches;
    CameraRefinement second = refine_from(result.cameras, again);
    if (second.changed) {
      second.rounds += result.rounds;
      second.focal_factor *= result.focal_factor;
      second.principal += result.principal;
      result = std::move(second);
      patches = again;
    }
  }
  result.given_tracks = int(others.size());
  result.patches = int(patches.size());
  return result;
}

}  // namespace photohull

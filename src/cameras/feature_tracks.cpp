// Based on: D. Lowe, "Distinctive image features from scale-invariant keypoints", 2004 [Lowe04];
// A. Gruen, "Adaptive least squares correlation", 1985 [Gruen85].
#include "cameras/feature_tracks.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <opencv2/core.hpp>
#include <opencv2/core/hal/hal.hpp>
#include <set>

#include "cameras/described_tracks.h"
#include "cameras/features.h"
#include "cameras/near_views.h"
#include "cameras/surface_patches.h"
#include "cameras/triangulate.h"
#include "core/disjoint_sets.h"
#include "core/error.h"
#include "photo/grey_image.h"
#include "views/undistort.h"

namespace photohull {
namespace {

struct Match {
  int view_a, feature_a, view_b, feature_b;
};

/// Pairs of views that see about the same.
std::vector<std::pair<int, int>> neighbour_pairs(std::span<const Camera> cameras,
                                                 const TrackOptions& options) {
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < int(cameras.size()); ++i)
    for (const int j : nearest_views(cameras, i, options.neighbours, options.largest_angle))
      pairs.emplace_back(std::min(i, j), std::max(i, j));
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

/// Line a x + b y + c = 0 with a^2 + b^2 = 1 in image b of what pixel p of image a may show.
class EpipolarLines {
 public:
  EpipolarLines(const Camera& a, const Camera& b) : a_(a), b_(b) {
    inverse_k_ = glm::transpose(glm::inverse(b.intrinsics.k()));
  }
  glm::dvec3 operator()(const glm::dvec2& p) const {
    const glm::dvec3 ray = b_.cam_from_world.rotation * a_.ray(p);
    const glm::dvec3 base = b_.to_camera(a_.center());
    const glm::dvec3 line = inverse_k_ * glm::cross(base, ray);
    return line / std::max(glm::length(glm::dvec2(line)), 1e-300);
  }

 private:
  const Camera &a_, &b_;
  glm::dmat3 inverse_k_;
};

/// For every feature of a the one of b near its epipolar line whose descriptor is clearly nearest;
/// -1 where there is none.
std::vector<int> best_matches(const Features& a, const Features& b, const Camera& camera_a,
                              const Camera& camera_b, const TrackOptions& options) {
  constexpr double kSamePlace = 3;  // pixels: features so near each other do not compete
  const float epipolar = float(options.epipolar);
  const EpipolarLines lines(camera_a, camera_b);
  const std::size_t count = b.pixels.size();
  std::vector<float> x(count), y(count), off(count);
  for (std::size_t j = 0; j < count; ++j) {
    x[j] = float(b.pixels[j].x);
    y[j] = float(b.pixels[j].y);
  }
  std::vector<int> best(a.pixels.size(), -1);
  struct Candidate {
    float distance;  // of the descriptors
    int feature;
  };
  std::vector<Candidate> found;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const glm::vec3 line(lines(a.pixels[i]));
    for (std::size_t j = 0; j < count; ++j)
      off[j] = std::abs(line.x * x[j] + line.y * y[j] + line.z);
    found.clear();
    for (std::size_t j = 0; j < count; ++j) {
      if (!(off[j] <= epipolar)) continue;
      const float squared = cv::hal::normL2Sqr_(
          a.descriptors.ptr<float>(int(i)), b.descriptors.ptr<float>(int(j)), a.descriptors.cols);
      found.push_back({std::sqrt(squared), int(j)});
    }
    if (found.empty()) continue;
    const Candidate nearest = *std::min_element(
        found.begin(), found.end(),
        [](const Candidate& x, const Candidate& y) { return x.distance < y.distance; });
    constexpr float kFarthest = 350;  // of descriptors: what nobody competes with must be near too
    if (nearest.distance > kFarthest) continue;
    if (std::all_of(found.begin(), found.end(), [&](const Candidate& rival) {
          return glm::distance(b.pixels[rival.feature], b.pixels[nearest.feature]) <= kSamePlace ||
                 nearest.distance < options.ratio * rival.distance;
        }))
      best[i] = nearest.feature;
  }
  return best;
}

/// Features joined by matches, without those that hold two features of a view.
std::vector<Track> join(const std::vector<Features>& features, const std::vector<Match>& matches) {
  std::vector<int> first(features.size() + 1, 0);
  for (std::size_t i = 0; i < features.size(); ++i)
    first[i + 1] = first[i] + int(features[i].pixels.size());
  DisjointSets joined(std::size_t(first.back()));
  for (const Match& m : matches)
    joined.unite(std::uint32_t(first[m.view_a] + m.feature_a),
                 std::uint32_t(first[m.view_b] + m.feature_b));
  std::vector<Track> by_root(joined.size());
  for (std::size_t v = 0; v < features.size(); ++v)
    for (std::size_t f = 0; f < features[v].pixels.size(); ++f)
      by_root[joined.root(std::uint32_t(first[v]) + std::uint32_t(f))].observations.push_back(
          {int(v), features[v].pixels[f]});
  std::vector<Track> tracks;
  for (Track& track : by_root) {
    const auto& o = track.observations;  // in the order of views
    const auto twice = std::adjacent_find(
        o.begin(), o.end(), [](const auto& x, const auto& y) { return x.view == y.view; });
    if (o.size() >= 2 && twice == o.end()) tracks.push_back(std::move(track));
  }
  return tracks;
}

/// Where the patch around a pixel of camera a lies in camera b, if the surface at `point` faces
/// between them.
std::optional<PatchPlace> place_in(const Camera& a, const glm::dvec2& pixel, const Camera& b,
                                   const glm::dvec3& point) {
  const glm::dvec3 normal =
      glm::normalize(glm::normalize(a.center() - point) + glm::normalize(b.center() - point));
  if (!b.project(point)) return std::nullopt;
  return place_on_plane(a, pixel, b, point, normal);
}

/// Features of neighbouring views that are each other's best matches.
std::vector<Match> match_all(std::span<const Camera> cameras, const std::vector<Features>& features,
                             const TrackOptions& options, Progress& progress) {
  const std::vector<std::pair<int, int>> pairs =
      options.pairs.empty() ? neighbour_pairs(cameras, options) : options.pairs;
  std::vector<std::vector<Match>> found(pairs.size());
  tbb::parallel_for(std::size_t(0), pairs.size(), [&](std::size_t p) {
    if (progress.cancelled()) return;
    const auto [i, j] = pairs[p];
    const std::vector<int> there =
        best_matches(features[i], features[j], cameras[i], cameras[j], options);
    const std::vector<int> back =
        best_matches(features[j], features[i], cameras[j], cameras[i], options);
    for (int f = 0; f < int(there.size()); ++f)
      if (there[f] >= 0 && back[there[f]] == f) found[p].push_back({i, f, j, there[f]});
  });
  progress.check_cancelled();
  std::vector<Match> matches;
  for (const std::vector<Match>& part : found)
    matches.insert(matches.end(), part.begin(), part.end());
  return matches;
}

/// Drops tracks that have a place in the same cell of two pixels as a given one's of that view.
void remove_repeated(std::span<const Track> given, std::vector<Track>& found) {
  constexpr double kSame = 2;  // pixels; the side of a cell
  using Cell = std::array<int, 3>;
  std::set<Cell> taken;
  const auto cell = [](const Observation& o) {
    return Cell{o.view, int(std::floor(o.pixel.x / kSame)), int(std::floor(o.pixel.y / kSame))};
  };
  for (const Track& track : given)
    for (const Observation& o : track.observations) taken.insert(cell(o));
  if (taken.empty()) return;
  std::erase_if(found, [&](const Track& track) {
    return std::any_of(track.observations.begin(), track.observations.end(),
                       [&](const Observation& o) { return taken.contains(cell(o)); });
  });
}

/// The longest tracks, until each view has so many observations in them; in the order in which
/// they were.
std::vector<Track> longest_first(std::vector<Track> tracks, std::size_t views, int enough) {
  std::vector<std::size_t> order(tracks.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return tracks[a].observations.size() > tracks[b].observations.size();
  });
  std::vector<int> counts(views, 0);
  std::vector<bool> kept(tracks.size(), false);
  for (const std::size_t i : order) {
    const std::vector<Observation>& o = tracks[i].observations;
    kept[i] = std::any_of(o.begin(), o.end(), [&](const Observation& x) {
      return counts[std::size_t(x.view)] < enough;
    });
    if (!kept[i]) continue;
    for (const Observation& x : o) ++counts[std::size_t(x.view)];
  }
  std::vector<Track> result;
  for (std::size_t i = 0; i < tracks.size(); ++i)
    if (kept[i]) result.push_back(std::move(tracks[i]));
  return result;
}

/// Aligns the other views' patches to that of the view in the middle; those that do not agree go.
void polish(std::span<const Camera> cameras, const std::vector<Features>& features,
            const TrackOptions& options, Track& track) {
  constexpr double kFarthest = 3;  // pixels from the feature found
  std::vector<Observation>& o = track.observations;
  const auto point = triangulate(cameras, track);
  std::vector<Observation> kept;
  if (point) {
    glm::dvec3 mean(0.0);
    for (const Observation& x : o) mean += glm::normalize(cameras[x.view].center() - *point);
    const auto middle = std::max_element(o.begin(), o.end(), [&](const auto& a, const auto& b) {
      return glm::dot(glm::normalize(cameras[a.view].center() - *point), mean) <
             glm::dot(glm::normalize(cameras[b.view].center() - *point), mean);
    });
    for (const Observation& x : o) {
      if (x.view == middle->view) {
        kept.push_back(x);
        continue;
      }
      auto start = place_in(cameras[middle->view], middle->pixel, cameras[x.view], *point);
      if (!start || !(glm::determinant(start->shape) > 0.1)) continue;
      start->center = x.pixel;
      const auto found =
          align_patch(features[middle->view].grey, middle->pixel, features[x.view].grey, *start,
                      options.patch_radius, kFarthest);
      if (found && found->agreement >= options.least_agreement)
        kept.push_back({x.view, found->place.center});
    }
  }
  o = std::move(kept);
}

/// Descriptors of the features that tracks were joined from, as far as these kept them.
std::vector<cv::Mat> descriptors_of(std::span<const Track> joined, std::span<const Track> kept,
                                    const std::vector<Features>& features) {
  using Place = std::array<double, 3>;
  std::map<Place, int> rows;
  for (std::size_t v = 0; v < features.size(); ++v)
    for (std::size_t f = 0; f < features[v].pixels.size(); ++f)
      rows[{double(v), features[v].pixels[f].x, features[v].pixels[f].y}] = int(f);
  std::vector<cv::Mat> all;
  for (std::size_t t = 0; t < kept.size(); ++t) {
    cv::Mat& own = all.emplace_back();
    for (const Observation& o : kept[t].observations)
      for (const Observation& from : joined[t].observations)
        if (from.view == o.view)
          own.push_back(features[std::size_t(o.view)].descriptors.row(
              rows.at({double(from.view), from.pixel.x, from.pixel.y})));
  }
  return all;
}

/// As find_tracks; `descriptors`: where the tracks' go, if they are wanted of those found.
std::vector<Track> search_tracks(std::span<const PreparedView> views, const TrackOptions& options,
                                 Progress& progress, std::span<const Track> given, bool search,
                                 std::vector<cv::Mat>* descriptors) {
  std::vector<Camera> cameras = options.cameras;
  if (cameras.empty())
    for (const PreparedView& view : views) cameras.push_back(view.camera);
  std::vector<Features> features(views.size());
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    if (!progress.cancelled())
      features[i] = search ? detect_features(views[i], options.features, FeatureSearch::kQuick)
                           : Features{{}, {}, smoothed(grey_image(views[i].image))};
  });
  progress.check_cancelled();
  progress.update(0.3);
  std::vector<Track> tracks(given.begin(), given.end());
  if (search) {
    std::vector<Track> found = join(features, match_all(cameras, features, options, progress));
    remove_repeated(given, found);
    tracks.insert(tracks.end(), std::make_move_iterator(found.begin()),
                  std::make_move_iterator(found.end()));
  }
  progress.update(0.8);
  if (options.enough > 0) tracks = longest_first(std::move(tracks), views.size(), options.enough);
  const std::vector<Track> joined = descriptors ? tracks : std::vector<Track>();
  tbb::parallel_for(std::size_t(0), tracks.size(), [&](std::size_t t) {
    if (!progress.cancelled()) polish(cameras, features, options, tracks[t]);
  });
  progress.check_cancelled();
  if (descriptors) *descriptors = descriptors_of(joined, tracks, features);
  return tracks;
}

bool is_short(const Track& track) { return track.observations.size() < 2; }

}  // namespace

std::vector<Track> find_tracks(std::span<const PreparedView> views, const TrackOptions& options,
                               Progress& progress, std::span<const Track> given, bool search) {
  std::vector<Track> tracks = search_tracks(views, options, progress, given, search, nullptr);
  std::erase_if(tracks, is_short);
  return tracks;
}

DescribedTracks find_described_tracks(std::span<const PreparedView> views,
                                      const TrackOptions& options, Progress& progress) {
  std::vector<cv::Mat> descriptors;
  std::vector<Track> tracks = search_tracks(views, options, progress, {}, true, &descriptors);
  DescribedTracks result;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    if (is_short(tracks[t])) continue;
    result.tracks.push_back(std::move(tracks[t]));
    result.descriptors.push_back(descriptors[t]);
  }
  return result;
}

std::vector<Track> undistorted_tracks(const Scene& scene, std::span<const PreparedView> views) {
  PHOTOHULL_CHECK_OP(scene.views.size(), ==, views.size());
  std::vector<Track> tracks;
  for (const SceneTrack& given : scene.tracks) {
    Track track;
    for (const SceneTrack::Observation& o : given.observations) {
      const SourceView& source = scene.views[std::size_t(o.view)];
      const Intrinsics &k = source.camera.intrinsics,
                       &now = views[std::size_t(o.view)].camera.intrinsics;
      const double y = (o.pixel.y - k.cy) / k.fy, x = (o.pixel.x - k.cx - k.skew * y) / k.fx;
      const auto ray = undistort_point(source.distortion, {x, y});
      if (!ray) continue;
      track.observations.push_back(
          {o.view, {now.fx * ray->x + now.skew * ray->y + now.cx, now.fy * ray->y + now.cy}});
    }
    if (track.observations.size() >= 2) tracks.push_back(std::move(track));
  }
  return tracks;
}

}  // namespace photohull

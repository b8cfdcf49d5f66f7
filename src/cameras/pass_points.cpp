// Based on: D. Lowe, "Distinctive image features from scale-invariant keypoints", 2004 [Lowe04].
#include "cameras/pass_points.h"

#include <tbb/parallel_for.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "cameras/described_tracks.h"
#include "cameras/triangulate.h"

namespace photohull {
namespace {

constexpr double kLargestResidual = 2;   // pixels, root mean square
constexpr double kSmallestSine = 0.035;  // two degrees between two of the rays
constexpr double kPlaceNoise = 2;        // pixels by which passes may place a feature differently
constexpr int kMostRows = 3;             // descriptors of a point
constexpr float kRatio = 0.85f;          // of the best to the second-best descriptor's distance
constexpr float kMostDistance = 0.75f;   // between descriptors of length 1

using Rows =
    Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

Rows rows_of(const cv::Mat& m) { return {m.ptr<float>(), m.rows, m.cols}; }

/// The largest sine of the angle between two of the track's rays.
double largest_sine(std::span<const Camera> cameras, const Track& track) {
  double largest = 0;
  for (const Observation& a : track.observations)
    for (const Observation& b : track.observations)
      if (a.view < b.view)
        largest =
            std::max(largest, glm::length(glm::cross(cameras[std::size_t(a.view)].ray(a.pixel),
                                                     cameras[std::size_t(b.view)].ray(b.pixel))));
  return largest;
}

/// World size of a pixel at a place, in the mean over the track's cameras.
double pixel_size(std::span<const Camera> cameras, const Track& track, const glm::dvec3& place) {
  double sum = 0;
  for (const Observation& o : track.observations) {
    const Camera& camera = cameras[std::size_t(o.view)];
    sum += camera.to_camera(place).z / camera.intrinsics.fx;
  }
  return sum / double(track.observations.size());
}

/// Some of the descriptors, evenly over the track's views.
void add_descriptors(const cv::Mat& all, int owner, DescribedPoints& points) {
  const int count = std::min(kMostRows, all.rows);
  for (int k = 0; k < count; ++k) {
    const cv::Mat row = all.row(count == 1 ? 0 : k * (all.rows - 1) / (count - 1));
    points.descriptors.push_back(cv::Mat(row / std::max(1e-6, cv::norm(row))));
    points.owners.push_back(owner);
  }
}

/// What a point's best descriptor finds among others; -1 where nothing is clearly nearest.
struct Found {
  int point = -1;
  float distance = 2;
};

class Search {
 public:
  explicit Search(const DescribedPoints& among) : among_(among) {}

  /// `likeness`: cosines with all rows.
  template <typename Row>
  Found nearest(const Row& likeness) const {
    Eigen::Index at = 0;
    const float best = likeness.maxCoeff(&at);
    const int point = among_.owners[std::size_t(at)];
    const auto place = std::size_t(point);
    float rival = -1;
    for (Eigen::Index j = 0; j < likeness.size(); ++j)
      if (likeness[j] > rival && !same_place(place, std::size_t(among_.owners[std::size_t(j)])))
        rival = likeness[j];
    const float distance = distance_of(best);
    if (distance > kMostDistance || distance > kRatio * distance_of(rival)) return {};
    return {point, distance};
  }

  bool same_place(std::size_t a, std::size_t b) const {
    return a == b || glm::distance(among_.places[a], among_.places[b]) <=
                         among_.tolerances[a] + among_.tolerances[b];
  }

 private:
  static float distance_of(float cosine) { return std::sqrt(std::max(0.0f, 2 - 2 * cosine)); }
  const DescribedPoints& among_;
};

/// Of each point of `from`.
std::vector<Found> search(const DescribedPoints& from, const DescribedPoints& to) {
  constexpr int kBlock = 128;
  const Rows a = rows_of(from.descriptors), b = rows_of(to.descriptors);
  const Search among(to);
  std::vector<Found> of_rows(std::size_t(a.rows()));
  const auto blocks = std::size_t((a.rows() + kBlock - 1) / kBlock);
  tbb::parallel_for(std::size_t(0), blocks, [&](std::size_t block) {
    const Eigen::Index first = Eigen::Index(block) * kBlock;
    const Eigen::Index count = std::min<Eigen::Index>(kBlock, a.rows() - first);
    const Eigen::MatrixXf likeness = b * a.middleRows(first, count).transpose();
    for (Eigen::Index i = 0; i < count; ++i)
      of_rows[std::size_t(first + i)] = among.nearest(likeness.col(i));
  });
  std::vector<Found> best(from.places.size());
  for (std::size_t r = 0; r < of_rows.size(); ++r) {
    Found& own = best[std::size_t(from.owners[r])];
    if (of_rows[r].point >= 0 && of_rows[r].distance < own.distance) own = of_rows[r];
  }
  return best;
}

}  // namespace

void DescribedPoints::add(const DescribedPoints& others, const RigidMotion& motion) {
  const int before = int(places.size());
  for (const glm::dvec3& place : others.places) places.push_back(motion(place));
  tolerances.insert(tolerances.end(), others.tolerances.begin(), others.tolerances.end());
  if (!others.descriptors.empty()) descriptors.push_back(others.descriptors);
  for (const int owner : others.owners) owners.push_back(before + owner);
}

DescribedPoints find_described_points(std::span<const PreparedView> views, const Box& box,
                                      Progress& progress) {
  TrackOptions options;
  options.features = 2000;
  options.epipolar = 4;
  options.enough = 400;
  const DescribedTracks found = find_described_tracks(views, options, progress);
  std::vector<Camera> cameras;
  for (const PreparedView& view : views) cameras.push_back(view.camera);
  DescribedPoints points;
  for (std::size_t t = 0; t < found.tracks.size(); ++t) {
    const Track& track = found.tracks[t];
    const auto place = triangulate(cameras, track);
    const double sine = largest_sine(cameras, track);
    if (!place || sine < kSmallestSine || !box.contains(*place) ||
        !(reprojection_rms(cameras, track, *place) < kLargestResidual))
      continue;
    points.places.push_back(*place);
    points.tolerances.push_back(kPlaceNoise * pixel_size(cameras, track, *place) *
                                std::max(1.0, 0.25 / sine));
    add_descriptors(found.descriptors[t], int(points.places.size()) - 1, points);
  }
  return points;
}

std::vector<PointPair> match_points(const DescribedPoints& from, const DescribedPoints& to) {
  std::vector<PointPair> pairs;
  if (from.places.empty() || to.places.empty()) return pairs;
  const std::vector<Found> there = search(from, to), back = search(to, from);
  const Search among(from);
  for (std::size_t i = 0; i < there.size(); ++i) {
    if (there[i].point < 0) continue;
    const auto j = std::size_t(there[i].point);
    if (back[j].point < 0 || !among.same_place(i, std::size_t(back[j].point))) continue;
    pairs.push_back({from.places[i], to.places[j], from.tolerances[i] + to.tolerances[j]});
  }
  return pairs;
}

}  // namespace photohull

#include "calib/find_turntable.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "core/error.h"

namespace photohull {
namespace {

constexpr std::size_t kFewestOfStation = 5;
constexpr std::size_t kMostPairs = 3000;
constexpr double kMostLean = 15, kLeastTurn = 20;      // degrees
constexpr double kLeastPair = 10, kMostPair = 150;     // degrees between two photographs
constexpr double kTurnedOff = 0.6, kMovedOff = 0.006;  // degrees; of the distance
constexpr double kDegree = 57.29577951308232;          // of a radian

struct TableAxis {
  glm::dvec3 direction, point;
};

/// Where a photograph's camera has the axis.
struct AxisPlace {
  glm::dvec3 direction, point;
};

/// 2 sin(angle) times the axis of a rotation.
glm::dvec3 odd_part(const glm::dmat3& r) {
  return {r[1][2] - r[2][1], r[2][0] - r[0][2], r[0][1] - r[1][0]};
}

double trace(const glm::dmat3& r) { return r[0][0] + r[1][1] + r[2][2]; }

/// By which a rotation turns about an axis, radians: the nearest one about it.
double turn_about_axis(const glm::dmat3& r, const glm::dvec3& axis) {
  return std::atan2(glm::dot(axis, odd_part(r)), trace(r) - glm::dot(axis, r * axis));
}

glm::dmat3 rotation_about(const glm::dvec3& d, double angle) {
  const glm::dmat3 cross(0, d.z, -d.y, -d.z, 0, d.x, d.y, -d.x, 0);
  return glm::dmat3(1.0) + std::sin(angle) * cross + (1 - std::cos(angle)) * cross * cross;
}

glm::dmat3 nearest_rotation(const glm::dmat3& m) {
  cv::Matx33d a, u, vt;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) a(r, c) = m[c][r];
  cv::Vec3d w;
  cv::SVD::compute(a, w, u, vt);
  if (cv::determinant(u * vt) < 0)
    for (int r = 0; r < 3; ++r) u(r, 2) = -u(r, 2);
  a = u * vt;
  glm::dmat3 out;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) out[c][r] = a(r, c);
  return out;
}

/// Degrees that are not covered by the longest arc without any of the angles (radians).
double span_of(std::vector<double> angles) {
  if (angles.empty()) return 0;
  std::ranges::sort(angles);
  double gap = angles.front() + 2 * CV_PI - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
  return (2 * CV_PI - gap) * kDegree;
}

class TurntableSearch {
 public:
  explicit TurntableSearch(const PoseResult& result) : photos_(result.photos) {
    for (std::size_t i = 0; i < photos_.size(); ++i)
      if (photos_[i].posed) posed_.push_back(i);
    out_.angles.assign(photos_.size(), NAN);
  }

  TurntableMotion run() {
    if (posed_.size() < kFewestOfStation)
      return refused(concat(posed_.size(), " photographs are posed, and ", kFewestOfStation,
                            " are needed to tell"));
    if (!search())
      return refused(turned_ ? "the cameras do not stand in one place before a sheet that turns"
                             : "the photographs show the sheet from one side");
    for (int round = 0; round < 4; ++round) {
      fit();
      gather();
      if (out_.stations.empty())
        return refused("the cameras do not stand in one place before a sheet that turns");
    }
    fit();
    std::size_t fitting = 0;
    for (const TurntableStation& station : out_.stations) fitting += station.photos.size();
    if (2 * fitting < posed_.size())
      return refused(concat("of ", posed_.size(), " photographs only ", fitting,
                            " fit one axis and a camera that stands still"));
    if (glm::dot(axis_.direction, glm::dvec3(0, 0, 1)) < std::cos(kMostLean / kDegree))
      return refused("the axis that fits leans too much to be a table's");
    report();
    if (span_ < kLeastTurn) return refused("the photographs show the sheet from one side");
    out_.found = true;
    return out_;
  }

 private:
  TurntableMotion refused(const std::string& reason) const {
    TurntableMotion out;
    out.reason = reason;
    out.angles.assign(photos_.size(), NAN);
    return out;
  }

  const Pose& pose(std::size_t i) const { return photos_[i].cam_from_world; }

  AxisPlace place(const TableAxis& axis, std::size_t i) const {
    return {pose(i).rotation * axis.direction, pose(i).rotation * axis.point + pose(i).translation};
  }

  bool alike(const AxisPlace& a, const AxisPlace& b) const {
    return glm::length(a.direction - b.direction) < kTurnedOff / kDegree &&
           glm::length(a.point - b.point) < kMovedOff * glm::length(a.point);
  }

  /// Photographs of the same lens whose cameras have the axis where the i-th has it.
  std::vector<std::size_t> alike_to(const TableAxis& axis, std::size_t i,
                                    const std::vector<std::size_t>& among) const {
    const AxisPlace own = place(axis, i);
    std::vector<std::size_t> all;
    for (const std::size_t k : among)
      if (photos_[k].camera == photos_[i].camera && alike(own, place(axis, k))) all.push_back(k);
    return all;
  }

  /// The axis of the motion from one photograph to another, where that may be a table's.
  bool axis_of_pair(std::size_t i, std::size_t j, TableAxis& axis) {
    const glm::dmat3 turn = glm::transpose(pose(i).rotation) * pose(j).rotation;
    const double angle = std::acos(std::clamp((trace(turn) - 1) / 2, -1.0, 1.0)) * kDegree;
    if (angle < kLeastPair || angle > kMostPair) return false;
    turned_ = true;
    axis.direction = glm::normalize(odd_part(turn));
    if (axis.direction.z < 0) axis.direction = -axis.direction;
    if (axis.direction.z < std::cos(kMostLean / kDegree)) return false;
    const glm::dmat3 a = pose(j).rotation - pose(i).rotation;
    axis.point = point_of(glm::transpose(a) * a,
                          glm::transpose(a) * (pose(i).translation - pose(j).translation));
    return true;
  }

  /// Solves normal * p = right for p in the plane z = 0.
  static glm::dvec3 point_of(const glm::dmat3& normal, const glm::dvec3& right) {
    return {glm::inverse(glm::dmat2(normal)) * glm::dvec2(right), 0};
  }

  /// The pair whose axis most photographs agree with. False where none is a table's.
  bool search() {
    const std::size_t n = posed_.size(), pairs = n * (n - 1) / 2;
    const std::size_t step = 1 + pairs / kMostPairs;
    std::size_t best = kFewestOfStation - 1, number = 0;
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = a + 1; b < n; ++b) {
        const std::size_t i = posed_[a], j = posed_[b];
        TableAxis axis;
        if (number++ % step != 0 || photos_[i].camera != photos_[j].camera) continue;
        if (!axis_of_pair(i, j, axis)) continue;
        const std::vector<std::size_t> fitting = alike_to(axis, i, posed_);
        if (fitting.size() <= best) continue;
        best = fitting.size();
        axis_ = axis;
        out_.stations = {{photos_[i].camera, fitting}};
      }
    return !out_.stations.empty();
  }

  /// Stations of the axis as it is, the largest first.
  void gather() {
    out_.stations.clear();
    std::vector<std::size_t> left = posed_;
    for (;;) {
      std::vector<std::size_t> best;
      for (const std::size_t i : left) {
        std::vector<std::size_t> fitting = alike_to(axis_, i, left);
        if (fitting.size() > best.size()) best = std::move(fitting);
      }
      if (best.size() < kFewestOfStation) return;
      std::erase_if(left, [&](std::size_t i) { return std::ranges::binary_search(best, i); });
      out_.stations.push_back({photos_[best[0]].camera, best});
    }
  }

  /// The axis that all stations have, by least squares.
  void fit() {
    glm::dmat3 normal(0.0);
    glm::dvec3 right(0.0);
    for (const TurntableStation& station : out_.stations) {
      glm::dmat3 mean(0.0);
      glm::dvec3 middle(0.0);
      for (const std::size_t k : station.photos)
        mean += pose(k).rotation, middle += pose(k).translation;
      mean /= double(station.photos.size()), middle /= double(station.photos.size());
      for (const std::size_t k : station.photos) {
        const glm::dmat3 a = pose(k).rotation - mean;
        normal += glm::transpose(a) * a;
        right += glm::transpose(a) * (middle - pose(k).translation);
      }
    }
    cv::Matx33d m, vectors;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) m(r, c) = normal[c][r];
    cv::Vec3d values;
    cv::eigen(m, values, vectors);  // in descending order, vectors as rows
    axis_.direction = {vectors(2, 0), vectors(2, 1), vectors(2, 2)};
    if (axis_.direction.z < 0) axis_.direction = -axis_.direction;
    axis_.point = point_of(normal, right);
  }

  void report() {
    out_.direction = axis_.direction, out_.point = axis_.point;
    double degrees = 0, lengths = 0, count = 0;
    for (const TurntableStation& station : out_.stations) {
      const glm::dmat3 still = camera_at_zero(station);
      const double first = turn_about_axis(glm::transpose(still) * pose(station.photos[0]).rotation,
                                           axis_.direction);
      glm::dvec3 middle(0.0);
      for (const std::size_t k : station.photos) middle += place(axis_, k).point;
      middle /= double(station.photos.size());
      std::vector<double> turns;
      for (const std::size_t k : station.photos) {
        const glm::dmat3 turn = glm::transpose(still) * pose(k).rotation;
        turns.push_back(turn_about_axis(turn, axis_.direction));
        out_.angles[k] = std::fmod((turns.back() - first) * kDegree + 360, 360);
        const glm::dvec3 off =
            odd_part(glm::transpose(rotation_about(axis_.direction, turns.back())) * turn);
        const glm::dvec3 moved = place(axis_, k).point - middle;
        degrees += glm::dot(off, off) / 4, lengths += glm::dot(moved, moved), ++count;
      }
      span_ = std::max(span_, span_of(turns));
    }
    out_.rms_degrees = std::sqrt(degrees / count) * kDegree;
    out_.rms_length = std::sqrt(lengths / count);
  }

  /// The camera's rotation where the table stands as in the station's first photograph, as all of
  /// its photographs have it.
  glm::dmat3 camera_at_zero(const TurntableStation& station) const {
    const glm::dmat3& first = pose(station.photos[0]).rotation;
    glm::dmat3 sum(0.0);
    for (const std::size_t k : station.photos) {
      const double angle =
          turn_about_axis(glm::transpose(first) * pose(k).rotation, axis_.direction);
      sum += pose(k).rotation * rotation_about(axis_.direction, -angle);
    }
    return nearest_rotation(sum);
  }

  const std::vector<PosedPhoto>& photos_;
  std::vector<std::size_t> posed_;
  TableAxis axis_{};
  TurntableMotion out_;
  double span_ = 0;      ///< degrees, of the station that turns most
  bool turned_ = false;  ///< a pair of photographs was looked at that differ by a turn
};

}  // namespace

TurntableMotion find_turntable(const PoseResult& result) { return TurntableSearch(result).run(); }

}  // namespace photohull

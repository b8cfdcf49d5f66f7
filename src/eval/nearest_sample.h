// The nearest of many points.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <vector>

namespace photohull::eval {

/// A k-d tree (nanoflann) over its own copy of the points, of which there must be at least one.
/// Const calls may run in parallel.
class NearestSample {
 public:
  explicit NearestSample(std::vector<glm::dvec3> points);
  ~NearestSample();
  NearestSample(const NearestSample&) = delete;
  NearestSample& operator=(const NearestSample&) = delete;

  struct Found {
    std::size_t index = 0;
    double distance = 0;
  };
  Found find(const glm::dvec3& p) const;
  /// Distance of the nearest of the points that is elsewhere than `p`, which is one of them; 0
  /// where the nearest eight coincide.
  double find_other(const glm::dvec3& p) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace photohull::eval

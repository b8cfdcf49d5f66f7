#include "eval/nearest_sample.h"

#include <cmath>
#include <nanoflann.hpp>

#include "core/error.h"

namespace photohull::eval {
namespace {

struct Cloud {
  std::vector<glm::dvec3> points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][int(axis)]; }
  template <typename Bounds>
  bool kdtree_get_bbox(Bounds&) const {
    return false;
  }
};

using Index =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3>;

}  // namespace

struct NearestSample::Tree {
  explicit Tree(std::vector<glm::dvec3> points) : cloud{std::move(points)}, index(3, cloud) {
    index.buildIndex();
  }
  Cloud cloud;
  Index index;
};

NearestSample::NearestSample(std::vector<glm::dvec3> points) {
  PHOTOHULL_CHECK(!points.empty());
  tree_ = std::make_unique<Tree>(std::move(points));
}

NearestSample::~NearestSample() = default;

NearestSample::Found NearestSample::find(const glm::dvec3& p) const {
  unsigned index = 0;
  double squared = 0;
  tree_->index.knnSearch(&p.x, 1, &index, &squared);
  return {index, std::sqrt(squared)};
}

double NearestSample::find_other(const glm::dvec3& p) const {
  constexpr std::size_t kMost = 8;
  unsigned indices[kMost];
  double squared[kMost];
  const std::size_t found = tree_->index.knnSearch(&p.x, kMost, indices, squared);
  for (std::size_t i = 0; i < found; ++i)
    if (squared[i] > 0) return std::sqrt(squared[i]);
  return 0;
}

}  // namespace photohull::eval

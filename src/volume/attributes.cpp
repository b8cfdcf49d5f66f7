#include "volume/attributes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/error.h"

namespace photohull {
namespace {

constexpr std::size_t kNotStored = std::numeric_limits<std::size_t>::max();

/// Index of a voxel among the stored ones; kNotStored where its brick is not stored.
std::size_t stored_index(const SparseVolume& volume, const glm::ivec3& voxel) {
  if (glm::any(glm::lessThan(voxel, glm::ivec3(0))) ||
      glm::any(glm::greaterThanEqual(voxel, volume.grid.voxels())))
    return kNotStored;
  const std::uint32_t slot = volume.table[volume.grid.brick_index(voxel / kBrickEdge)];
  if (slot >= volume.bricks.size()) return kNotStored;
  return std::size_t(slot) * kBrickVoxels + voxel_offset(voxel % kBrickEdge);
}

/// A voxel is not known by less than this: a mean over such weights is rounding noise.
constexpr float kLeastWeight = 1e-4f;

struct Point {
  glm::dvec3 voxel{0.0};
  glm::vec3 colour{0};
  float confidence = 0;
};

/// The attributes under way: sums of values times weights, and the weights. They are kept for the
/// voxels near the surface, and for those that points of the mesh reach.
class Splatter {
 public:
  Splatter(const SparseVolume& volume, const TriMesh& mesh) : volume_(volume), mesh_(mesh) {
    auto mask = std::make_shared<VoxelMask>(volume.bricks.size());
    tbb::parallel_for(std::size_t(0), volume.bricks.size(), [&](std::size_t slot) {
      for (std::size_t i = slot * kBrickVoxels; i < (slot + 1) * kBrickVoxels; ++i)
        if (is_near_surface(i)) mask->mark(i);
    });
    for_points(
        [&](const Point& p) { for_corners(p, [&](std::size_t i, float) { mask->mark(i); }); });
    mask->count();
    mask_ = mask;
    weight_.assign(mask->marked(), 0.0f);
    if (!mesh.colours.empty())
      sums_.colour = {mask_, glm::vec3(0), glm::vec3(VolumeAttributes::kUnknown)};
    if (!mesh.confidence.empty()) sums_.confidence = {mask_, 0.0f, VolumeAttributes::kUnknown};
  }

  VolumeAttributes run() {
    for_points([&](const Point& p) { splat(p); });
    fill_neighbours();
    return take();
  }

 private:
  Point point(std::size_t vertex) const;
  template <typename F>
  void for_points(F&& f) const;
  template <typename F>
  void for_corners(const Point& p, F&& f) const;
  void splat(const Point& point);
  void fill_neighbours();
  void fill_from_neighbours(std::size_t index, const glm::ivec3& voxel);
  VolumeAttributes take();
  bool is_near_surface(std::size_t index) const {
    return std::abs(volume_.distance[index]) < VolumeAttributes::kReach;
  }

  const SparseVolume& volume_;
  const TriMesh& mesh_;
  std::shared_ptr<const VoxelMask> mask_;
  VolumeAttributes sums_;
  std::vector<float> weight_;  // by the mask's rank
};

Point Splatter::point(std::size_t vertex) const {
  Point p;
  p.voxel = (mesh_.world(vertex) - volume_.grid.origin) / volume_.grid.voxel_size;
  if (!mesh_.colours.empty()) p.colour = mesh_.colours[vertex];
  if (!mesh_.confidence.empty()) p.confidence = mesh_.confidence[vertex];
  return p;
}

/// The vertices; and, as an adaptive mesh has triangles that span many voxels, points of these
/// about a voxel apart.
template <typename F>
void Splatter::for_points(F&& f) const {
  constexpr double kSpan = 2.0;  // voxels; smaller triangles are covered by their corners
  for (std::size_t i = 0; i < mesh_.positions.size(); ++i) f(point(i));
  for (const auto& [a, b, c] : mesh_.triangles) {
    const glm::vec3 &pa = mesh_.positions[a], &pb = mesh_.positions[b], &pc = mesh_.positions[c];
    const double longest =
        std::max({glm::distance(pa, pb), glm::distance(pb, pc), glm::distance(pc, pa)}) /
        volume_.grid.voxel_size;
    if (!(longest > kSpan)) continue;
    const Point corners[3] = {point(a), point(b), point(c)};
    const int steps = int(std::ceil(longest));
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j) {
        const double u = double(i) / steps, v = double(j) / steps, w = 1 - u - v;
        Point p;
        p.voxel = u * corners[0].voxel + v * corners[1].voxel + w * corners[2].voxel;
        p.colour = float(u) * corners[0].colour + float(v) * corners[1].colour +
                   float(w) * corners[2].colour;
        p.confidence = float(u * corners[0].confidence + v * corners[1].confidence +
                             w * corners[2].confidence);
        f(p);
      }
  }
}

/// Calls f(voxel, weight) for the stored voxels around a point.
template <typename F>
void Splatter::for_corners(const Point& p, F&& f) const {
  const glm::dvec3 cell = glm::floor(p.voxel);
  const glm::vec3 at(p.voxel - cell);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 step(corner >> 2, (corner >> 1) & 1, corner & 1);
    const std::size_t i = stored_index(volume_, glm::ivec3(cell) + step);
    if (i == kNotStored) continue;
    const glm::vec3 share = glm::mix(1.0f - at, at, glm::vec3(step));
    const float weight = share.x * share.y * share.z;
    if (!(weight < kLeastWeight)) f(i, weight);
  }
}

void Splatter::splat(const Point& p) {
  for_corners(p, [&](std::size_t i, float weight) {
    const std::size_t rank = mask_->rank(i);
    weight_[rank] += weight;
    if (!sums_.colour.empty()) sums_.colour.ranked(rank) += weight * p.colour;
    if (!sums_.confidence.empty()) sums_.confidence.ranked(rank) += weight * p.confidence;
  });
}

/// Writes only to voxels without weight and reads only those with weight: order does not matter.
void Splatter::fill_from_neighbours(std::size_t rank, const glm::ivec3& voxel) {
  float weight = 0;
  glm::vec3 colour(0);
  float confidence = 0;
  for (int n = 0; n < 27; ++n) {
    const glm::ivec3 step(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
    const std::size_t i = stored_index(volume_, voxel + step);
    if (i == kNotStored || !mask_->has(i)) continue;
    const std::size_t other = mask_->rank(i);
    if (weight_[other] == 0) continue;
    weight += weight_[other];
    if (!sums_.colour.empty()) colour += sums_.colour.ranked(other);
    if (!sums_.confidence.empty()) confidence += sums_.confidence.ranked(other);
  }
  const bool known = weight > 0;
  if (!sums_.colour.empty())
    sums_.colour.ranked(rank) = known ? colour / weight : glm::vec3(VolumeAttributes::kUnknown);
  if (!sums_.confidence.empty())
    sums_.confidence.ranked(rank) = known ? confidence / weight : VolumeAttributes::kUnknown;
}

void Splatter::fill_neighbours() {
  tbb::parallel_for(std::size_t(0), volume_.bricks.size(), [&](std::size_t slot) {
    const glm::ivec3 corner = volume_.bricks[slot] * kBrickEdge;
    for (int offset = 0; offset < kBrickVoxels; ++offset) {
      const std::size_t i = slot * kBrickVoxels + std::size_t(offset);
      if (!is_near_surface(i)) continue;
      const std::size_t rank = mask_->rank(i);
      if (weight_[rank] == 0)
        fill_from_neighbours(rank, corner + glm::ivec3(offset >> 6, (offset >> 3) & 7, offset & 7));
    }
  });
}

VolumeAttributes Splatter::take() {
  tbb::parallel_for(std::size_t(0), volume_.bricks.size(), [&](std::size_t slot) {
    for (std::size_t i = slot * kBrickVoxels; i < (slot + 1) * kBrickVoxels; ++i) {
      if (!mask_->has(i)) continue;
      const std::size_t rank = mask_->rank(i);
      const bool near = is_near_surface(i);
      if (near && weight_[rank] == 0) continue;  // Filled from its neighbours, or unknown.
      if (!sums_.colour.empty()) {
        glm::vec3& colour = sums_.colour.ranked(rank);
        colour = near ? colour / weight_[rank] : glm::vec3(VolumeAttributes::kUnknown);
      }
      if (!sums_.confidence.empty()) {
        float& confidence = sums_.confidence.ranked(rank);
        confidence = near ? confidence / weight_[rank] : VolumeAttributes::kUnknown;
      }
    }
  });
  return std::move(sums_);
}

}  // namespace

VolumeAttributes attributes_from_mesh(const SparseVolume& volume, const TriMesh& mesh) {
  const std::size_t vertices = mesh.positions.size();
  PHOTOHULL_CHECK(mesh.colours.empty() || mesh.colours.size() == vertices);
  PHOTOHULL_CHECK(mesh.confidence.empty() || mesh.confidence.size() == vertices);
  if (mesh.colours.empty() && mesh.confidence.empty()) return {};
  return Splatter(volume, mesh).run();
}

}  // namespace photohull

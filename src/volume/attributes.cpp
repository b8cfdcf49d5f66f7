#include "volume/attributes.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

/// The attributes under way: sums of values times weights, and the weights.
class Splatter {
 public:
  Splatter(const SparseVolume& volume, const TriMesh& mesh) : volume_(volume), mesh_(mesh) {
    const std::size_t count = volume.distance.size();
    weight_.assign(count, 0.0f);
    if (!mesh.colours.empty()) sums_.colour.assign(count, glm::vec3(0));
    if (!mesh.confidence.empty()) sums_.confidence.assign(count, 0.0f);
  }

  void splat_vertices();
  void splat_large_triangles();
  void fill_neighbours();
  VolumeAttributes take();

 private:
  Point point(std::size_t vertex) const;
  void splat(const Point& point);
  void fill_from_neighbours(std::size_t index, const glm::ivec3& voxel);
  bool is_near_surface(std::size_t index) const {
    return std::abs(volume_.distance[index]) < VolumeAttributes::kReach;
  }

  const SparseVolume& volume_;
  const TriMesh& mesh_;
  VolumeAttributes sums_;
  std::vector<float> weight_;
};

Point Splatter::point(std::size_t vertex) const {
  Point p;
  p.voxel = (mesh_.world(vertex) - volume_.grid.origin) / volume_.grid.voxel_size;
  if (!mesh_.colours.empty()) p.colour = mesh_.colours[vertex];
  if (!mesh_.confidence.empty()) p.confidence = mesh_.confidence[vertex];
  return p;
}

void Splatter::splat(const Point& p) {
  const glm::dvec3 cell = glm::floor(p.voxel);
  const glm::vec3 at(p.voxel - cell);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 step(corner >> 2, (corner >> 1) & 1, corner & 1);
    const std::size_t i = stored_index(volume_, glm::ivec3(cell) + step);
    if (i == kNotStored) continue;
    const glm::vec3 share = glm::mix(1.0f - at, at, glm::vec3(step));
    const float weight = share.x * share.y * share.z;
    if (weight < kLeastWeight) continue;
    weight_[i] += weight;
    if (!sums_.colour.empty()) sums_.colour[i] += weight * p.colour;
    if (!sums_.confidence.empty()) sums_.confidence[i] += weight * p.confidence;
  }
}

void Splatter::splat_vertices() {
  for (std::size_t i = 0; i < mesh_.positions.size(); ++i) splat(point(i));
}

/// An adaptive mesh has triangles that span many voxels: they are sampled about once a voxel.
void Splatter::splat_large_triangles() {
  constexpr double kSpan = 2.0;  // voxels; smaller triangles are covered by their corners
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
        splat(p);
      }
  }
}

/// Writes only to voxels without weight and reads only those with weight: order does not matter.
void Splatter::fill_from_neighbours(std::size_t index, const glm::ivec3& voxel) {
  float weight = 0;
  glm::vec3 colour(0);
  float confidence = 0;
  for (int n = 0; n < 27; ++n) {
    const glm::ivec3 step(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
    const std::size_t i = stored_index(volume_, voxel + step);
    if (i == kNotStored || weight_[i] == 0) continue;
    weight += weight_[i];
    if (!sums_.colour.empty()) colour += sums_.colour[i];
    if (!sums_.confidence.empty()) confidence += sums_.confidence[i];
  }
  const bool known = weight > 0;
  if (!sums_.colour.empty())
    sums_.colour[index] = known ? colour / weight : glm::vec3(VolumeAttributes::kUnknown);
  if (!sums_.confidence.empty())
    sums_.confidence[index] = known ? confidence / weight : VolumeAttributes::kUnknown;
}

void Splatter::fill_neighbours() {
  tbb::parallel_for(std::size_t(0), volume_.bricks.size(), [&](std::size_t slot) {
    const glm::ivec3 corner = volume_.bricks[slot] * kBrickEdge;
    for (int offset = 0; offset < kBrickVoxels; ++offset) {
      const std::size_t i = slot * kBrickVoxels + offset;
      if (weight_[i] == 0 && is_near_surface(i))
        fill_from_neighbours(i, corner + glm::ivec3(offset >> 6, (offset >> 3) & 7, offset & 7));
    }
  });
}

VolumeAttributes Splatter::take() {
  const tbb::blocked_range<std::size_t> voxels(0, weight_.size(), 1 << 16);
  tbb::parallel_for(voxels, [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const bool near = is_near_surface(i);
      if (near && weight_[i] == 0) continue;  // Filled from its neighbours, or unknown.
      if (!sums_.colour.empty())
        sums_.colour[i] =
            near ? sums_.colour[i] / weight_[i] : glm::vec3(VolumeAttributes::kUnknown);
      if (!sums_.confidence.empty())
        sums_.confidence[i] = near ? sums_.confidence[i] / weight_[i] : VolumeAttributes::kUnknown;
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
  Splatter splatter(volume, mesh);
  splatter.splat_vertices();
  splatter.splat_large_triangles();
  splatter.fill_neighbours();
  return splatter.take();
}

}  // namespace photohull

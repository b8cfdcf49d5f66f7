// Based on: J. A. Baerentzen, H. Aanaes, "Signed distance computation using the angle weighted
// pseudonormal", 2005.
#include "eval/signed_distance.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "eval/topology.h"
#include "raycast/closest_point.h"

namespace photohull::eval {
namespace {

glm::dvec3 unit(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0 ? v / length : glm::dvec3(0);
}

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// For each face the sums of unit normals over the faces at each of its sides.
std::vector<std::array<glm::vec3, 3>> sum_at_edges(const TriMesh& mesh,
                                                   const std::vector<std::uint32_t>& joined,
                                                   const std::vector<glm::vec3>& face_normals) {
  std::vector<std::array<glm::vec3, 3>> result(mesh.triangles.size());
  for (std::size_t t = 0; t < result.size(); ++t) result[t].fill(face_normals[t]);
  const std::vector<HalfEdge> edges = sorted_half_edges(mesh, joined);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    glm::dvec3 sum(0);
    for (; end < edges.size() && edges[end].key == edges[i].key; ++end)
      sum += face_normals[edges[end].triangle];
    for (; i < end; ++i) result[edges[i].triangle][edges[i].side] = sum;
  }
  return result;
}

std::vector<glm::vec3> sum_at_vertices(const TriMesh& mesh,
                                       const std::vector<std::uint32_t>& joined,
                                       const std::vector<glm::vec3>& face_normals) {
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const auto corner = [&](int k) {
        return glm::dvec3(mesh.positions[mesh.triangles[t][(i + k) % 3]]);
      };
      const double angle = angle_between(corner(1) - corner(0), corner(2) - corner(0));
      sums[joined[mesh.triangles[t][i]]] += angle * glm::dvec3(face_normals[t]);
    }
  std::vector<glm::vec3> result(sums.size());
  std::transform(sums.begin(), sums.end(), result.begin(), unit);
  return result;
}

}  // namespace

SignedDistance::SignedDistance(const TriMesh& whole) {
  const TriMesh mesh = without_degenerate_faces(whole);
  if (mesh.triangles.empty()) throw Error("no face of the mesh has an area; give a surface");
  surface_ = std::make_unique<ClosestPoint>(mesh);
  const std::vector<std::uint32_t> joined = joined_vertices(mesh);
  corners_ = mesh.triangles;
  for (auto& face : corners_)
    for (std::uint32_t& corner : face) corner = joined[corner];
  face_normals_.resize(mesh.triangles.size());
  for (std::size_t t = 0; t < face_normals_.size(); ++t)
    face_normals_[t] = unit(area_vector(mesh, t));
  edge_normals_ = sum_at_edges(mesh, joined, face_normals_);
  vertex_normals_ = sum_at_vertices(mesh, joined, face_normals_);
}

SignedDistance::~SignedDistance() = default;
SignedDistance::SignedDistance(SignedDistance&&) noexcept = default;
SignedDistance& SignedDistance::operator=(SignedDistance&&) noexcept = default;

SignedDistance::Value SignedDistance::at(const glm::dvec3& p, std::uint32_t hint) const {
  const NearestPoint nearest = surface_->nearest(p, hint);
  const glm::dvec3& w = nearest.weights;
  glm::dvec3 normal = face_normals_[nearest.triangle];
  for (int i = 0; i < 3; ++i) {
    if (w[i] == 1) normal = vertex_normals_[corners_[nearest.triangle][i]];
    const bool on_edge = w[i] == 0 && w[(i + 1) % 3] > 0 && w[(i + 2) % 3] > 0;
    if (on_edge) normal = edge_normals_[nearest.triangle][(i + 1) % 3];
  }
  const double side = glm::dot(p - nearest.point, normal);
  return {side < 0 ? -nearest.distance : nearest.distance, unit(normal), nearest.triangle};
}

}  // namespace photohull::eval

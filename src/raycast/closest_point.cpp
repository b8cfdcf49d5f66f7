// Based on: Embree's point queries (Wald et al. 2014) and Ericson, "Real-Time Collision Detection",
// 2005, section 5.1.
#include "raycast/closest_point.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/error.h"
#include "raycast/check_mesh.h"
#include "raycast/scene_builder.h"

namespace photohull {
namespace {

/// Offers the nearest point of the edge between corners i and j.
void try_edge(const glm::dvec3& p, const std::array<glm::dvec3, 3>& t, int i, int j,
              TrianglePoint& best) {
  const glm::dvec3 edge = t[j] - t[i];
  const double squared = glm::dot(edge, edge);
  const double s = squared > 0 ? std::clamp(glm::dot(p - t[i], edge) / squared, 0.0, 1.0) : 0.0;
  TrianglePoint found;
  found.weights = glm::dvec3(0);
  found.weights[i] = 1 - s;
  found.weights[j] = s;
  found.point = s < 1 ? t[i] + s * edge : t[j];
  const glm::dvec3 away = p - found.point;
  found.squared_distance = glm::dot(away, away);
  if (found.squared_distance < best.squared_distance) best = found;
}

/// Offers the foot of the perpendicular where it lies inside.
void try_face(const glm::dvec3& p, const std::array<glm::dvec3, 3>& t, TrianglePoint& best) {
  const glm::dvec3 n = glm::cross(t[1] - t[0], t[2] - t[0]);
  glm::dvec3 w(glm::dot(glm::cross(t[2] - t[1], p - t[1]), n),
               glm::dot(glm::cross(t[0] - t[2], p - t[2]), n),
               glm::dot(glm::cross(t[1] - t[0], p - t[0]), n));
  if (!(w.x > 0 && w.y > 0 && w.z > 0)) return;
  w /= w.x + w.y + w.z;
  TrianglePoint found;
  found.weights = w;
  found.point = t[0] + w.y * (t[1] - t[0]) + w.z * (t[2] - t[0]);
  const glm::dvec3 away = p - found.point;
  found.squared_distance = glm::dot(away, away);
  if (found.squared_distance < best.squared_distance) best = found;
}

}  // namespace

TrianglePoint closest_on_triangle(const glm::dvec3& p, const std::array<glm::dvec3, 3>& triangle) {
  TrianglePoint best;
  try_edge(p, triangle, 0, 1, best);
  try_edge(p, triangle, 1, 2, best);
  try_edge(p, triangle, 2, 0, best);
  try_face(p, triangle, best);
  return best;
}

struct ClosestPoint::Data {
  std::vector<glm::vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  glm::dvec3 origin{0.0};
  SceneBuilder builder;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  ~Data() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
  void build();
};

void ClosestPoint::Data::build() {
  device = rtcNewDevice(nullptr);
  if (!device)
    throw Error(
        "the distance queries (Embree) cannot be started: most likely too little memory or too few "
        "threads are available or allowed (ulimit -a); free some or raise the limits");
  scene = rtcNewScene(device);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(glm::vec3), positions.size());
  void* faces = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                        3 * sizeof(std::uint32_t), triangles.size());
  if (vertices && faces) {
    std::memcpy(vertices, positions.data(), positions.size() * sizeof(glm::vec3));
    std::memcpy(faces, triangles.data(), triangles.size() * 3 * sizeof(std::uint32_t));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    builder.commit(scene);
  }
  rtcReleaseGeometry(geometry);
  const RTCError failure = rtcGetDeviceError(device);
  if (failure == RTC_ERROR_OUT_OF_MEMORY)
    throw Error(concat("there is not enough memory to measure distances to a mesh of ",
                       triangles.size(), " triangles; simplify it"));
  if (failure != RTC_ERROR_NONE)
    throw Error(concat("the distance queries (Embree) failed on a mesh of ", triangles.size(),
                       " triangles with error ", int(failure)));
}

namespace {

/// One query on its way through the tree.
struct Search {
  const std::vector<glm::vec3>& positions;
  const std::vector<std::array<std::uint32_t, 3>>& triangles;
  glm::dvec3 p;  ///< relative to the mesh's origin
  TrianglePoint best;
  std::uint32_t triangle = 0;

  /// Takes a triangle's nearest point when it is nearer, or as near with a lower index.
  bool measure(std::uint32_t candidate) {
    const auto& [a, b, c] = triangles[candidate];
    const TrianglePoint found = closest_on_triangle(p, {positions[a], positions[b], positions[c]});
    const bool tie = found.squared_distance == best.squared_distance && candidate < triangle;
    if (!(found.squared_distance < best.squared_distance) && !tie) return false;
    best = found;
    triangle = candidate;
    return true;
  }
};

/// The tree sees the query rounded to float and compares in float: room for both, so that no
/// triangle that is as near as `distance` is left out.
float safe_radius(double distance, const glm::dvec3& p) {
  const double reach = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return float((distance + 1e-6 * (distance + reach)) * (1 + 1e-6)) +
         std::numeric_limits<float>::min();
}

bool visit(RTCPointQueryFunctionArguments* arguments) {
  auto& search = *static_cast<Search*>(arguments->userPtr);
  if (!search.measure(arguments->primID)) return false;
  const float radius = safe_radius(std::sqrt(search.best.squared_distance), search.p);
  if (!(radius < arguments->query->radius)) return false;
  arguments->query->radius = radius;
  return true;
}

}  // namespace

ClosestPoint::ClosestPoint(const TriMesh& mesh) : data_(std::make_unique<Data>()) {
  check_mesh(mesh);
  data_->positions = mesh.positions;
  data_->triangles = mesh.triangles;
  data_->origin = mesh.origin;
  data_->build();
}

ClosestPoint::~ClosestPoint() = default;
ClosestPoint::ClosestPoint(ClosestPoint&&) noexcept = default;
ClosestPoint& ClosestPoint::operator=(ClosestPoint&&) noexcept = default;

NearestPoint ClosestPoint::nearest(const glm::dvec3& p, std::uint32_t hint) const {
  PHOTOHULL_CHECK_OP(hint, <, data_->triangles.size());
  Search search{data_->positions, data_->triangles, p - data_->origin, {}, hint};
  search.measure(hint);
  RTCPointQuery query;
  query.x = float(search.p.x), query.y = float(search.p.y), query.z = float(search.p.z);
  query.time = 0;
  query.radius = safe_radius(std::sqrt(search.best.squared_distance), search.p);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(data_->scene, &query, &context, visit, &search);
  PHOTOHULL_CHECK(search.best.squared_distance < std::numeric_limits<double>::infinity());
  return {std::sqrt(search.best.squared_distance), search.best.point + data_->origin,
          search.best.weights, search.triangle};
}

}  // namespace photohull

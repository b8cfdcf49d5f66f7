#include "raycast/ray_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "raycast/check_mesh.h"
#include "raycast/scene_builder.h"

namespace photohull {
namespace {

constexpr int kPacket = 16;

void write_ray(RTCRay& ray, const glm::vec3& origin, const glm::vec3& direction, double tnear,
               double tfar) {
  ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
  ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
  ray.tnear = float(tnear), ray.tfar = float(tfar);
  ray.time = 0, ray.mask = 0xffffffffu, ray.id = 0, ray.flags = 0;
}

/// Lanes beyond the rays at hand repeat nothing; `valid` switches them off.
void write_packet(RTCRay16& packet, std::span<const Ray> rays, const glm::dvec3& shift,
                  int* valid) {
  for (int i = 0; i < kPacket; ++i) {
    const bool on = std::size_t(i) < rays.size();
    valid[i] = on ? -1 : 0;
    const Ray& ray = rays[on ? i : 0];
    const glm::vec3 origin(ray.origin - shift), direction(ray.direction);
    packet.org_x[i] = origin.x, packet.org_y[i] = origin.y, packet.org_z[i] = origin.z;
    packet.dir_x[i] = direction.x, packet.dir_y[i] = direction.y, packet.dir_z[i] = direction.z;
    packet.tnear[i] = float(ray.tnear), packet.tfar[i] = float(ray.tfar);
    packet.time[i] = 0, packet.mask[i] = 0xffffffffu, packet.id[i] = 0, packet.flags[i] = 0;
  }
}

RTCIntersectContext coherent_context() {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}

}  // namespace

struct RayScene::Device {
  SceneBuilder builder;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  Device() {
    device = rtcNewDevice(nullptr);
    if (!device)
      throw Error(
          "the ray caster (Embree) cannot be started: most likely too little memory or too few "
          "threads are available or allowed (ulimit -a); free some or raise the limits");
    scene = rtcNewScene(device);
    // Coherent packets never end in scenes that are compact as well as robust, where the processor
    // has AVX-512 (Embree 3.13.5).
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  }
  ~Device() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  void add(const TriMesh& mesh) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* positions =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(glm::vec3), mesh.positions.size());
    // Vertices need room behind the last one, which the mesh has not.
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               mesh.triangles.data(), 0, 3 * sizeof(std::uint32_t),
                               mesh.triangles.size());
    if (positions) {
      std::memcpy(positions, mesh.positions.data(), mesh.positions.size() * sizeof(glm::vec3));
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(scene, geometry);
      builder.commit(scene);
    }
    rtcReleaseGeometry(geometry);
    const RTCError failure = rtcGetDeviceError(device);
    if (failure == RTC_ERROR_OUT_OF_MEMORY)
      throw Error(concat("there is not enough memory to cast rays at a mesh of ",
                         mesh.triangles.size(), " triangles; simplify it"));
    if (failure != RTC_ERROR_NONE)
      throw Error(concat("the ray caster (Embree) failed on a mesh of ", mesh.triangles.size(),
                         " triangles with its error ", int(failure)));
  }
};

RayScene::RayScene(const TriMesh& mesh) : origin_(mesh.origin) {
  check_mesh(mesh);
  device_ = std::make_unique<Device>();
  device_->add(mesh);
}

RayScene::~RayScene() = default;

std::optional<Hit> RayScene::closest(const glm::dvec3& origin, const glm::dvec3& direction,
                                     double tnear, double tfar) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query;
  write_ray(query.ray, glm::vec3(origin - origin_), glm::vec3(direction), tnear, tfar);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(device_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return Hit{query.hit.primID, query.hit.u, query.hit.v, query.ray.tfar};
}

bool RayScene::occluded(const glm::dvec3& origin, const glm::dvec3& direction, double tnear,
                        double tfar) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay query;
  write_ray(query, glm::vec3(origin - origin_), glm::vec3(direction), tnear, tfar);
  rtcOccluded1(device_->scene, &context, &query);
  return query.tfar < 0;
}

void RayScene::closest(std::span<const Ray> rays, std::span<Hit> hits) const {
  PHOTOHULL_CHECK_OP(rays.size(), ==, hits.size());
  RTCIntersectContext context = coherent_context();
  alignas(64) int valid[kPacket];
  alignas(64) RTCRayHit16 packet;
  for (std::size_t first = 0; first < rays.size(); first += kPacket) {
    const std::size_t count = std::min<std::size_t>(kPacket, rays.size() - first);
    write_packet(packet.ray, rays.subspan(first, count), origin_, valid);
    for (int i = 0; i < kPacket; ++i) {
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect16(valid, device_->scene, &context, &packet);
    for (std::size_t i = 0; i < count; ++i)
      hits[first + i] =
          packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID
              ? Hit{}
              : Hit{packet.hit.primID[i], packet.hit.u[i], packet.hit.v[i], packet.ray.tfar[i]};
  }
}

void RayScene::occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const {
  PHOTOHULL_CHECK_OP(rays.size(), ==, blocked.size());
  RTCIntersectContext context = coherent_context();
  alignas(64) int valid[kPacket];
  alignas(64) RTCRay16 packet;
  for (std::size_t first = 0; first < rays.size(); first += kPacket) {
    const std::size_t count = std::min<std::size_t>(kPacket, rays.size() - first);
    write_packet(packet, rays.subspan(first, count), origin_, valid);
    rtcOccluded16(valid, device_->scene, &context, &packet);
    for (std::size_t i = 0; i < count; ++i) blocked[first + i] = packet.tfar[i] < 0;
  }
}

}  // namespace photohull

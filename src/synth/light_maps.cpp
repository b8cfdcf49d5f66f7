#include "synth/light_maps.h"

#include <algorithm>
#include <cmath>

#include "visibility/viewpoints.h"

namespace photohull::synth {
namespace {

/// Parallel light comes from a viewpoint so many diagonals away: far enough that its rays are
/// parallel to 0.3 degrees, near enough for depths of single precision.
constexpr double kFarAway = 100;
/// Texels of bias that depths at that distance ask for, whatever the technique.
constexpr double kLeastBias = 0.05;
/// A point light nearer than so many radii of the object's sphere looks around itself.
constexpr double kAround = 1.3;

std::vector<Camera> viewpoints_of(const Light& light, const Surface& surface, int texels) {
  const glm::dvec3 middle = surface.box.center();
  const double radius = 0.5 * surface.diagonal;
  const glm::dvec3 place =
      light.directional ? middle + kFarAway * surface.diagonal * light.place : light.place;
  if (glm::length(place - middle) < kAround * radius) return visibility::look_around(place, texels);
  return {visibility::frame_sphere(place, middle, radius, texels, texels)};
}

}  // namespace

LightMaps::LightMaps(gpu::Context& context, const LightSpec& spec, const Surface& surface,
                     const std::vector<Light>& lights)
    : context_(context),
      surface_(surface),
      lights_(lights),
      geometry_(visibility::Geometry::of_mesh(surface.mesh)),
      technique_(visibility::parse_technique("light.shadow_test", spec.shadow_test)) {
  technique_.resolution = spec.shadow_texels;
  technique_.bias_texels = std::max(technique_.bias_texels, kLeastBias);
  for (const Light& light : lights) {
    std::vector<Map>& maps = maps_.emplace_back();
    for (const Camera& viewpoint : viewpoints_of(light, surface, spec.shadow_texels))
      maps.push_back({viewpoint, {}});
  }
}

void LightMaps::look_from(const Camera& eye) {
  eye_ = eye;
  for (std::vector<Map>& maps : maps_)
    for (Map& map : maps)
      if (!map.drawn || technique_.warp != visibility::Warp::kNone)
        map.drawn = visibility::render_map(context_, map.viewpoint, geometry_, technique_, eye);
}

visibility::Sample LightMaps::sample_at(const Ray& ray, const Hit& hit) const {
  visibility::Sample s;
  s.position = ray.origin + hit.t * ray.direction;
  s.normal = glm::dvec3(surface_.face_normals[hit.triangle]);
  if (dot(s.normal, ray.direction) > 0) s.normal = -s.normal;
  s.id = hit.triangle;
  const auto beside = [&](const glm::dvec3& right) {
    const glm::dvec3 direction = ray.direction + right;
    const double slant = dot(direction, s.normal);
    if (std::abs(slant) < 1e-9) return glm::dvec3(0.0);
    return ray.origin + direction * (dot(s.position - ray.origin, s.normal) / slant) - s.position;
  };
  const glm::dmat3 to_world = transpose(eye_.cam_from_world.rotation);
  s.step_x = beside(to_world[0] / eye_.intrinsics.fx);
  s.step_y = beside(to_world[1] / eye_.intrinsics.fy);
  return s;
}

std::vector<float> LightMaps::share_of(std::size_t light,
                                       const std::vector<visibility::Sample>& samples) const {
  const std::vector<Map>& maps = maps_[light];
  if (maps.size() == 1) return visibility::visible(context_, *maps[0].drawn, samples);
  std::vector<float> out(samples.size());
  for (const Map& map : maps) {
    std::vector<visibility::Sample> own;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const glm::dvec3 p = map.viewpoint.to_camera(samples[i].position);
      if (p.z < std::max(std::abs(p.x), std::abs(p.y))) continue;
      own.push_back(samples[i]), places.push_back(i);
    }
    const std::vector<float> found = visibility::visible(context_, *map.drawn, own);
    for (std::size_t i = 0; i < own.size(); ++i)
      out[places[i]] = std::max(out[places[i]], found[i]);
  }
  return out;
}

LightShares LightMaps::shares(std::span<const Ray> rays, std::span<const Hit> hits) const {
  LightShares out(lights_.size(), std::vector<float>(rays.size()));
  std::vector<visibility::Sample> all(rays.size()), asked;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (hits[i]) all[i] = sample_at(rays[i], hits[i]);
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < lights_.size(); ++k) {
    const Light& light = lights_[k];
    asked.clear(), places.clear();
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const glm::dvec3 to_light = light.directional ? light.place : light.place - all[i].position;
      if (!hits[i] || dot(all[i].normal, to_light) <= 0) continue;
      asked.push_back(all[i]), places.push_back(i);
    }
    const std::vector<float> found = share_of(k, asked);
    for (std::size_t i = 0; i < asked.size(); ++i) out[k][places[i]] = found[i];
  }
  return out;
}

}  // namespace photohull::synth

#include "synth/shading.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "synth/random.h"
#include "synth/solid_noise.h"

namespace photohull::synth {
namespace {

constexpr float kAmplify = 2.0f;  ///< gradient noise to about [-1, 1]

/// Axes that no face of the built-in shapes is parallel to, for the checker.
const glm::dmat3 kSkewAxes = {
    {0.8365, 0.4830, -0.2588}, {-0.4441, 0.8725, 0.2033}, {0.3240, -0.0551, 0.9444}};

glm::vec3 tint(std::uint32_t patch, std::uint32_t seed) {
  Random random(seed, 0xfacade, patch);
  glm::vec3 colour;
  for (int c = 0; c < 3; ++c) colour[c] = float(0.15 + 0.75 * random.uniform());
  return colour;
}

float smooth_step(float low, float high, float x) {
  const float s = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return s * s * (3 - 2 * s);
}

/// About the vertical, radians.
glm::dmat3 turned(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c, s, 0, -s, c, 0, 0, 0, 1};
}

}  // namespace

Shading::Shading(const Spec& spec, const Surface& surface, double pixel, const PrintedSheet* sheet,
                 double turn)
    : spec_(spec),
      surface_(surface),
      sheet_(sheet),
      room_from_world_(turned(turn)),
      seed_(std::uint32_t(mix_bits(spec.seed))) {
  const glm::dmat3 back = transpose(room_from_world_);
  for (const DirectionalLight& d : spec.light.directional)
    lights_.push_back({back * normalize(d.direction), glm::vec3(d.colour), true});
  for (const PointLight& p : spec.light.point)
    lights_.push_back({surface.box.center() + surface.diagonal * (back * p.position),
                       glm::vec3(p.colour), false});
  const MaterialSpec& m = spec.material;
  checker_ = (m.period_pixels > 0 ? m.period_pixels * pixel : m.size * surface.own.diagonal) / 2;
  clutter_ = spec.background.type == "clutter";
  double farthest = 0;
  for (const double factor : spec.cameras.distances) farthest = std::max(farthest, factor);
  clutter_radius_ = spec.background.distance * spec.cameras.distance * farthest * surface.diagonal;
}

glm::vec3 Shading::base(std::uint32_t patch) const {
  return spec_.material.faces ? tint(patch, seed_) : glm::vec3(spec_.material.base);
}

void Shading::add_checker(std::span<Point> points) const {
  const float contrast = float(spec_.material.contrast);
  for (Point& point : points) {
    const glm::dvec3 field = floor(kSkewAxes * surface_.own.place(point.position) / checker_);
    const bool odd = std::fmod(std::abs(field.x + field.y + field.z), 2.0) == 1.0;
    point.albedo *= odd ? 1 + contrast : 1 - contrast;
  }
}

void Shading::add_noise_texture(std::span<Point> points) const {
  const MaterialSpec& m = spec_.material;
  thread_local NoisePoints places;
  thread_local std::vector<float> light, red, blue;
  places.resize(points.size());
  const double scale = 1 / (surface_.own.diagonal * m.size);
  for (std::size_t i = 0; i < points.size(); ++i)
    places.set(i, glm::vec3(scale * surface_.own.place(points[i].position)) + 57.3f);
  light.resize(points.size());
  octave_noise(places, 1, m.octaves, float(m.gain), seed_, light);
  red.assign(points.size(), 0), blue.assign(points.size(), 0);
  const float contrast = float(m.contrast), chroma = float(m.chroma) * contrast * kAmplify;
  if (chroma > 0) {
    add_noise(places, 1.7f, glm::vec3(0), chroma, seed_ ^ 0x5bd1e995u, red);
    add_noise(places, 1.7f, glm::vec3(0), chroma, seed_ ^ 0x27d4eb2fu, blue);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::vec3 hue(1 + red[i], 1 - 0.5f * (red[i] + blue[i]), 1 + blue[i]);
    points[i].albedo *=
        (1 + contrast * std::clamp(kAmplify * light[i], -0.95f, 1.0f)) * max(hue, glm::vec3(0));
  }
}

/// What lies below the surface shines through: the pattern, which fills space, at haze_depth along
/// the line of sight, so that it moves against the surface from view to view.
void Shading::add_haze(std::span<Point> points) const {
  const MaterialSpec& m = spec_.material;
  thread_local std::vector<Point> below;
  below.assign(points.begin(), points.end());
  for (Point& p : below) {
    p.albedo = glm::vec3(1);
    p.position -= m.haze_depth * surface_.own.diagonal * glm::dvec3(p.to_eye);
  }
  std::vector<glm::vec3> plain;
  for (Point& p : points) plain.push_back(p.albedo), p.albedo = glm::vec3(1);
  add_pattern(points);
  add_pattern(below);
  const float share = float(m.haze);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i].albedo = plain[i] * mix(points[i].albedo, below[i].albedo, share);
}

void Shading::add_pattern(std::span<Point> points) const {
  if (spec_.material.pattern == "checker")
    add_checker(points);
  else
    add_noise_texture(points);
}

void Shading::set_albedo(std::span<Point> points, std::span<const Hit> hits) const {
  for (Point& point : points) point.albedo = base(surface_.patches[hits[point.index].triangle]);
  if (spec_.material.contrast > 0) {
    if (spec_.material.haze > 0)
      add_haze(points);
    else
      add_pattern(points);
  }
  for (Point& point : points) point.albedo = min(point.albedo, glm::vec3(1));
}

/// The GGX lobe [Walter07] scaled to 1 at its peak.
glm::vec3 Shading::highlight(const glm::vec3& normal, const glm::vec3& to_eye,
                             const glm::vec3& to_light) const {
  const float cosine = std::max(0.0f, dot(normal, normalize(to_eye + to_light)));
  const float a2 = float(spec_.material.roughness * spec_.material.roughness);
  const float below = cosine * cosine * (a2 - 1) + 1;
  return glm::vec3(float(spec_.material.gloss) * a2 * a2 / (below * below));
}

void Shading::shade(std::span<const Ray> rays, std::span<const Hit> hits, const LightShares& shares,
                    std::span<glm::vec3> out) const {
  thread_local std::vector<Point> points;
  thread_local std::vector<Ray> shadow;
  thread_local std::vector<std::uint8_t> blocked;
  points.clear();
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i]) continue;
    const glm::dvec3 at = rays[i].origin + hits[i].t * rays[i].direction;
    const glm::vec3 to_eye(-normalize(rays[i].direction));
    glm::vec3 face = surface_.face_normals[hits[i].triangle];
    const float side = dot(face, to_eye) < 0 ? -1.0f : 1.0f;
    points.push_back({at, at + 1e-5 * surface_.diagonal * glm::dvec3(side * face),
                      side * surface_.normal(hits[i]), glm::vec3(0), to_eye, i});
  }
  set_albedo(points, hits);
  const glm::vec3 ambient(spec_.light.ambient);
  for (const Point& p : points) out[p.index] = ambient * p.albedo * (0.8f + 0.2f * p.normal.z);
  for (std::size_t k = 0; k < lights_.size(); ++k) {
    const Light& light = lights_[k];
    shadow.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      shadow[i].origin = points[i].origin;
      shadow[i].direction = light.directional ? light.place : light.place - points[i].origin;
      shadow[i].tfar = light.directional ? INFINITY : 1.0;
    }
    blocked.assign(shadow.size(), 0);
    if (spec_.light.shadows && shares.empty()) surface_.rays->occluded(shadow, blocked);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Point& p = points[i];
      const glm::vec3 to_light(normalize(shadow[i].direction));
      const float cosine = dot(p.normal, to_light);
      const float share = shares.empty() ? float(!blocked[i]) : shares[k][p.index];
      if (share <= 0 || cosine <= 0) continue;
      glm::vec3 arriving = light.colour;
      if (!light.directional) {
        const double distance = length(shadow[i].direction) / surface_.diagonal;
        arriving *= float(1 / std::max(1e-6, distance * distance));
      }
      glm::vec3 reflected = p.albedo;
      if (spec_.material.gloss > 0) reflected += highlight(p.normal, p.to_eye, to_light);
      out[p.index] += share * cosine * arriving * reflected;
    }
  }
}

/// Paper and ink scatter light to all sides alike; the object's shadow falls on them.
glm::vec3 Shading::on_sheet(const PrintedSheet::Seen& seen) const {
  const glm::vec3 albedo(seen.albedo);
  glm::vec3 light = glm::vec3(spec_.light.ambient) * albedo * float(0.8 + 0.2 * seen.normal.z);
  const glm::dvec3 from = seen.position + 1e-5 * surface_.diagonal * seen.normal;
  for (const Light& source : lights_) {
    const glm::dvec3 towards = source.directional ? source.place : source.place - from;
    const double cosine = dot(seen.normal, normalize(towards));
    if (cosine <= 0) continue;
    const double reach = source.directional ? INFINITY : 1.0;
    if (spec_.light.shadows && surface_.rays->occluded(from, towards, 0, reach)) continue;
    const double distance = length(towards) / surface_.diagonal;
    const double fall = source.directional ? 1 : 1 / std::max(1e-6, distance * distance);
    light += float(cosine * fall) * source.colour * albedo;
  }
  return light;
}

glm::vec3 Shading::background(const Ray& ray, std::size_t view) const {
  if (sheet_)
    if (const auto seen = sheet_->see(ray, view)) return on_sheet(*seen);
  const BackgroundSpec& b = spec_.background;
  if (!clutter_) return glm::vec3(b.colour);
  // The sphere around the scene, from within.
  const glm::dvec3 from = room_from_world_ * (ray.origin - surface_.box.center()),
                   d = room_from_world_ * normalize(ray.direction);
  const double along = dot(from, d);
  const double reach =
      -along +
      std::sqrt(std::max(0.0, along * along - dot(from, from) + clutter_radius_ * clutter_radius_));
  const glm::vec3 q((from + reach * d) / (b.size * surface_.diagonal));
  const std::uint32_t seed =
      seed_ ^ 0xc1a77e45u ^ (b.moving ? std::uint32_t(mix_bits(view + 1)) : 0);
  float fine = 0;
  for (int i = 0; i < 3; ++i)
    fine += 0.5f * gradient_noise(float(2 << i) * q.x, float(2 << i) * q.y, float(2 << i) * q.z,
                                  seed + 5u + std::uint32_t(i));
  glm::vec3 colour;
  for (int c = 0; c < 3; ++c) {
    const float patch =
        gradient_noise(0.7f * q.x, 0.7f * q.y, 0.7f * q.z, seed + 17u * std::uint32_t(c + 1));
    colour[c] = 0.08f + 0.55f * smooth_step(-0.08f, 0.08f, patch) *
                            (1 + 0.8f * std::clamp(fine, -1.0f, 1.0f));
  }
  return colour;
}

}  // namespace photohull::synth

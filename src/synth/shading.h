// Light from the surface and from behind it. Internal to synth.
#pragma once

#include <vector>

#include "synth/printed_sheet.h"
#include "synth/surface.h"

namespace photohull::synth {

struct Light {
  glm::dvec3 place;  ///< position, or unit direction towards it
  glm::vec3 colour;
  bool directional;
};

/// Of each light, the share that reaches each ray's hit.
using LightShares = std::vector<std::vector<float>>;

/// What the surface reflects at every point, and how much light reaches it. Linear light.
class Shading {
 public:
  /// `pixel` is the world size of the mean camera's pixel at the middle of the box.
  /// `sheet`, under the object, outlives this; null: none. `turn`: radians by which object and
  /// sheet have turned about the vertical axis through the middle of the object's box, before
  /// lights and background that stand still.
  Shading(const Spec& spec, const Surface& surface, double pixel,
          const PrintedSheet* sheet = nullptr, double turn = 0);

  /// Directional ones first, in the spec's order.
  const std::vector<Light>& lights() const { return lights_; }
  /// Radiance of hits towards where their rays came from; as many as rays, misses left alone. Where
  /// `shares` is empty, rays to the lights are cast.
  void shade(std::span<const Ray> rays, std::span<const Hit> hits, const LightShares& shares,
             std::span<glm::vec3> out) const;
  /// Has what is seen past the object finer detail than a pixel?
  bool fine_background() const { return sheet_ != nullptr; }
  /// What is seen past the object along a ray of view `view`.
  glm::vec3 background(const Ray& ray, std::size_t view) const;

 private:
  /// Where a ray met the surface.
  struct Point {
    glm::dvec3 position, origin;  ///< origin: off the surface, for shadow rays
    glm::vec3 normal, albedo, to_eye;
    std::size_t index;  ///< of the ray
  };

  glm::vec3 on_sheet(const PrintedSheet::Seen& seen) const;
  glm::vec3 base(std::uint32_t patch) const;
  void add_checker(std::span<Point> points) const;
  void add_noise_texture(std::span<Point> points) const;
  void add_pattern(std::span<Point> points) const;
  void add_haze(std::span<Point> points) const;
  void set_albedo(std::span<Point> points, std::span<const Hit> hits) const;
  glm::vec3 highlight(const glm::vec3& normal, const glm::vec3& to_eye,
                      const glm::vec3& to_light) const;

  const Spec& spec_;
  const Surface& surface_;
  const PrintedSheet* sheet_;
  glm::dmat3 room_from_world_;  ///< about the middle of the box
  std::vector<Light> lights_;   ///< in the world, which turns with the object
  double checker_ = 0;          ///< edge of a field, world units
  bool clutter_ = false;
  double clutter_radius_ = 0;  ///< world units
  std::uint32_t seed_;
};

}  // namespace photohull::synth

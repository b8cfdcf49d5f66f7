// Visibility maps in plain double precision, from the formulas: every texel against every triangle.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "visibility/kernels/visibility_map.h"

namespace photohull::visibility::reference {

struct Texel {
  double first = 0, second = 0;  ///< +infinity where there is none
  double slope = 0;              ///< greatest change of the nearest surface from texel to texel
  std::uint32_t id = shaders::kNoTriangle;  ///< as the map keeps it
  bool unsure = false;  ///< an edge passes so near that rounding decides what is drawn
};

/// A line of sight: points origin + w * direction.
struct Sight {
  glm::dvec3 origin, direction;
};

/// Where a line meets a triangle's plane, or the triangle.
struct Crossing {
  double w = 0;
  double b0 = 0, b1 = 0, b2 = 0;  ///< barycentric coordinates
  bool exists = false;            ///< not parallel to the plane
  bool inside() const { return exists && b0 >= 0 && b1 >= 0 && b2 >= 0; }
};

class Map {
 public:
  /// The layout is the device's own (layout.h has no second version; it has tests of its own).
  /// `id_of` maps triangles to ids; empty: themselves.
  Map(const MapLayout& layout, const Technique& technique, const TriMesh& mesh,
      std::span<const std::uint32_t> id_of = {});

  const Texel& texel(int part, int x, int y) const;
  /// Takes what the device drew into texels that are unsure.
  void adopt_unsure(const VisibilityMap& device);
  /// As visibility::visible for all techniques.
  double visible(const Sample& sample) const;

  /// Triangles that have area in a texel and lie before the viewpoint, by exact clipping.
  std::vector<std::uint32_t> triangles_in(int part, const glm::ivec2& texel) const;
  /// Of those, the ones that no other hides in the whole texel.
  std::vector<std::uint32_t> seen_in(int part, const glm::ivec2& texel) const;
  /// The one of least depth at the texel's centre, its plane taken within its own depths.
  std::uint32_t nearest_in(int part, const glm::ivec2& texel) const;
  /// What coverage detection links to a texel.
  std::vector<std::uint32_t> links_of(int part, const glm::ivec2& texel) const;

 private:
  struct Place {
    int part;
    glm::dvec2 at;
    double w, z;
  };
  Place locate(int part, const glm::dvec3& p) const;
  Sight sight(int part, const glm::dvec2& at) const;
  double depth_on(int part, const Sight& sight, double w) const;
  Crossing cross(const Sight& sight, std::size_t triangle) const;
  std::vector<glm::dvec2> clipped(int part, std::size_t triangle, const glm::ivec2& texel) const;
  void draw_texel(int part, const glm::ivec2& at, Texel& texel) const;
  double receiver_depth(const Sample& s, const Place& place, const glm::dvec2& at) const;
  double map_depth(const Sample& s, const Place& place, const Texel& texel) const;
  double change_within_texel(const Sample& s, const Place& place) const;
  bool lit(const Sample& s, const Place& place, const glm::dvec2& at) const;
  double pcf(const Sample& s, const Place& place) const;
  double variance(const Place& place) const;
  double exact(const Sample& s, const Place& place) const;
  double depth_of(int part, std::uint32_t triangle, const glm::dvec2& at) const;
  std::uint32_t kept(int part, const glm::ivec2& texel) const;
  bool holds_place(int part, std::uint32_t triangle, const glm::dvec2& at) const;
  double least_height(int part, std::uint32_t triangle, const glm::dvec2& at) const;
  bool surrounded(const Sample& s, const Place& place) const;
  bool hides(const Sample& s, const Place& place, std::uint32_t triangle, const glm::dvec2& at,
             double slack) const;
  double slack_beside(const Sample& s, const Place& place) const;
  bool in_gap(const Sample& s, const Place& place) const;
  double sub_pixel(const Sample& s, const Place& place) const;
  double coverage(const Sample& s, const Place& place) const;
  glm::dvec2 moments(int part, const glm::ivec2& texel) const;
  glm::ivec2 clamped(const glm::ivec2& texel) const;

  MapLayout layout_;
  Technique technique_;
  std::vector<std::array<glm::dvec3, 3>> triangles_;  ///< relative to the mesh's origin
  std::vector<std::uint32_t> ids_;
  glm::dvec3 origin_;
  std::vector<Texel> texels_;
  mutable std::vector<std::uint32_t> nearest_;  ///< a texel; found when first asked for
  double bias_ = 0, z_max_ = 0;
};

}  // namespace photohull::visibility::reference

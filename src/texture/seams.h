// Private to module texture: what colours differ by where charts of two photographs meet, and what
// is added to them so that they do not.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/mesh.h"
#include "core/prepared_view.h"
#include "core/progress.h"
#include "texture/charts.h"
#include "texture/fill_colour.h"

namespace photohull::texture {

/// A side of two triangles that have their colours from different planes.
struct Seam {
  std::array<std::uint32_t, 2> faces;
  std::array<std::uint32_t, 2> vertices;  ///< its ends
};

/// Sides between planes, each once, in the order of their first triangle.
std::vector<Seam> find_seams(const TriMesh& mesh,
                             const std::vector<std::array<std::uint32_t, 3>>& neighbours,
                             const std::vector<std::uint32_t>& plane_of_face);

/// What is added to roots of linear light, of every vertex on every plane that colours a triangle
/// around it.
class Levels {
 public:
  Levels(const TriMesh& mesh, const std::vector<std::uint32_t>& plane_of_face);

  const glm::vec3& at(std::uint32_t vertex, std::uint32_t plane) const {
    return values_[index(vertex, plane)];
  }
  std::size_t index(std::uint32_t vertex, std::uint32_t plane) const;
  std::size_t size() const { return planes_.size(); }
  void set(std::vector<glm::vec3> values) { values_ = std::move(values); }

 private:
  std::vector<std::size_t> first_;     // of each vertex
  std::vector<std::uint32_t> planes_;  // of each vertex, ascending
  std::vector<glm::vec3> values_;
};

/// Least squares: across seams the colours are to be the same on average along each side, and what
/// is added is to change little from vertex to vertex [LempitskyIvanov07; Waechter14]. Colours of
/// the photographs count only where they are clear on both sides. Throws Cancelled.
Levels level_seams(const TriMesh& mesh, std::span<const PreparedView> views, double scale,
                   const Planes& planes, std::span<const Seam> seams, const FillColour& fill,
                   Progress& progress);

}  // namespace photohull::texture

#include "texture/fill_colour.h"

#include "texture/surface.h"

namespace photohull::texture {

glm::vec3 FillColour::root(const glm::dvec3& point, std::uint32_t& hint) const {
  const NearestPoint near = nearest_.nearest(point, hint);
  hint = near.triangle;
  const auto& corners = mesh_.triangles[near.triangle];
  glm::vec3 linear(0);
  for (int i = 0; i < 3; ++i) linear += float(near.weights[i]) * mesh_.colours[corners[i]];
  return root_of(linear);
}

}  // namespace photohull::texture

// Private to module texture: connected triangles that lie side by side in one projection.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/mesh.h"
#include "core/progress.h"
#include "texture/projection.h"

namespace photohull::texture {

/// Texels around a chart that are its own, against what is sampled across its border.
inline constexpr int kGutter = 3;

/// A piece of the surface on its plane, at one texel a pixel.
struct Chart {
  std::uint32_t plane = 0;  ///< index into the projectors
  std::vector<std::uint32_t> faces;
  glm::ivec2 low{0};   ///< pixel of its plane that its top-left texel shows
  glm::ivec2 size{0};  ///< texels, the gutter included
  std::uint32_t page = 0;
  glm::ivec2 place{0};  ///< of its top-left texel on the page
};

/// Planes that colours come from: the views', and one along each axis for what no view shows.
struct Planes {
  std::vector<Projector> projectors;
  std::size_t views = 0;  ///< how many of them are views'; they are the first
  std::vector<std::uint32_t> of_face;
};

/// Every triangle is in one chart. No two of a chart cover the same pixel centre by more than a
/// tenth of a pixel: where the surface folds in the projection, another one begins; and where one
/// would be larger than `most_edge` texels, unless that is a single triangle. In the order of
/// planes; in parallel, the same for any number of threads. Throws Cancelled.
std::vector<Chart> make_charts(const TriMesh& mesh,
                               const std::vector<std::array<std::uint32_t, 3>>& neighbours,
                               const Planes& planes, int most_edge, Progress& progress);

}  // namespace photohull::texture

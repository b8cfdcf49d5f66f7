// Private to module texture: the colours of a page.
#pragma once

#include <cstdint>
#include <span>

#include "core/mesh_texture.h"
#include "core/prepared_view.h"
#include "core/progress.h"
#include "texture/fill_colour.h"
#include "texture/page_plan.h"

namespace photohull::texture {

struct PaintedPage {
  TexturePage page;
  std::int64_t texels = 0;  ///< that show the surface
  std::int64_t filled = 0;  ///< of these, with the fill's colours, for no photograph is clear there
};

/// What a page is painted with; all outlives it.
struct Paint {
  const TriMesh& mesh;
  std::span<const PreparedView> views;
  double scale;  ///< of the photographs
  const Planes& planes;
  std::span<const Chart> charts;
  std::span<const Seam> seams;
  const Levels& levels;
  const FillColour& fill;
};

/// Each texel is a pixel of its chart's photograph, where that is clear, and else the fill's
/// colour; on both sides of a seam the two photographs are blended. Texels that show nothing repeat
/// what is nearby. In parallel; the same for any number of threads. Throws Cancelled.
PaintedPage paint_page(const Paint& paint, const PagePlan& plan, Progress& progress);

}  // namespace photohull::texture

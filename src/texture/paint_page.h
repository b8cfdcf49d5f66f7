// Private to module texture: the colours of a page.
#pragma once

#include <cstdint>
#include <span>

#include "core/mesh_texture.h"
#include "core/progress.h"
#include "texture/face_views.h"
#include "texture/fill_colour.h"
#include "texture/page_plan.h"
#include "texture/view_sources.h"

namespace photohull::texture {

struct PaintedPage {
  RgbImage page;
  std::int64_t texels = 0;  ///< that show the surface
  std::int64_t filled = 0;  ///< of these, with the fill's colours, for no photograph is clear there
  std::int64_t most_at_once = 0;  ///< texels of the charts that were painted at a time
};

/// What a page is painted with; all outlives it.
struct Paint {
  const TriMesh& mesh;
  ViewSources& sources;
  const Planes& planes;
  const FaceViews& seen;
  std::span<const Chart> charts;
  const FillColour& fill;
  double detail;  ///< by which the fine part is multiplied
  double noise;   ///< standard deviation of the photographs' pixels, roots of linear light
  std::int64_t canvas_texels;  ///< of charts that are painted at a time; one chart in any case
};

/// Bytes that a page takes for each texel while it is painted: faces, colours, the page itself.
inline constexpr std::int64_t kPageBytes = 14;

/// Each texel has the coarse part of the mean of all photographs that show it clearly, and the fine
/// part of its chart's photograph and of those that agree with it to a part of a pixel
/// (texture/canvas.h); where none is clear, the fill's colour. Texels that show nothing repeat what
/// is nearby. In parallel; the same for any number of threads. Throws Cancelled.
PaintedPage paint_page(const Paint& paint, const PagePlan& plan, Progress& progress);

}  // namespace photohull::texture

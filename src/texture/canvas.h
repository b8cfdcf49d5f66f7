// Private to module texture: the texels of a chart while photographs are put together on them.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "core/mesh.h"
#include "texture/charts.h"
#include "texture/fill_colour.h"
#include "texture/page_plan.h"
#include "texture/view_sources.h"

namespace photohull::texture {

/// A photograph as canvases take it up.
struct CanvasView {
  std::uint32_t view = 0;
  const ViewSource& source;
  const std::vector<float>& weights;  ///< of vertices (face_views.h)
};

/// What a texel of the surface became.
struct CanvasColour {
  glm::vec3 root{0};    ///< of linear light
  bool filled = false;  ///< no photograph is clear there
};

/// Bytes that a canvas takes for each texel of its chart, while a photograph is added.
inline constexpr std::int64_t kCanvasBytes = 156;

/// Of one chart. What it refers to must outlive it.
class Canvas {
 public:
  Canvas(const TriMesh& mesh, const Planes& planes, const Chart& chart, std::uint32_t chart_index,
         const PagePlan& plan);

  const Chart& chart() const { return chart_; }
  /// The pixels of the chart's own photograph, as they are.
  void take_own(const ViewSource& source);
  /// Another photograph, or the own one again, resampled on the texels. It counts in the mean of
  /// all, and in the fine detail as far as it agrees with the own one to a part of a pixel.
  /// `noise`: standard deviation of photographs' pixels, roots of linear light.
  void add(const CanvasView& view, double noise);
  /// The coarse part of the mean of all photographs and the fine part of those that agree, times
  /// `detail`; the mean itself, as far as the others do not agree with the own one, for then no
  /// single one is right; the fill's colour where none is clear. Calls `f(texel, colour)` for each
  /// that shows the surface.
  void finish(const FillColour& fill, double detail,
              const std::function<void(const glm::ivec2&, const CanvasColour&)>& f) const;

 private:
  /// Two parts of a texel's colour that add up to it.
  struct Bands {
    glm::vec3 coarse{0}, fine{0};
  };

  /// Of all photographs; the fill's colour where none is clear.
  std::vector<glm::vec3> mean_of_all(const FillColour& fill) const;
  /// The coarse part of `mean`, and the fine part of the photographs that agree.
  std::vector<Bands> split(const std::vector<glm::vec3>& mean) const;
  /// A photograph on the texels: colour, and how much of it is clear (w).
  std::vector<glm::vec4> resample(const CanvasView& view) const;
  std::size_t index(int x, int y) const { return std::size_t(y) * chart_.size.x + x; }
  std::uint32_t face(int x, int y) const { return plan_.face(chart_.place + glm::ivec2(x, y)); }
  glm::vec3 weights(std::size_t i) const;
  glm::vec3 position(std::size_t i, std::uint32_t face) const;

  const TriMesh& mesh_;
  const Chart& chart_;
  std::uint32_t chart_index_;
  const PagePlan& plan_;
  std::vector<glm::vec2> places_;  // on the triangles: weights of the second and third corners
  std::vector<glm::vec4> own_;     // roots of linear light, and how much of it is clear
  std::vector<glm::vec4> all_;     // sum of all photographs' colours, and of their weights
  std::vector<glm::vec4> fine_;    // the same of those that agree, on the level of the own one
  std::vector<glm::vec2>
      agreeing_;  // weights of the others that agree with the own one, and of all others
};

}  // namespace photohull::texture

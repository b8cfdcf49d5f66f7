// Private to module texture: what each texel of a page shows.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/mesh.h"
#include "texture/charts.h"
#include "texture/seams.h"

namespace photohull::texture {

/// A texel of a chart that lies near a seam.
struct BandTexel {
  glm::ivec2 texel{0};      ///< in the chart
  std::uint32_t plane = 0;  ///< of the nearest seam's other side
  float share = 0;          ///< of the other side's colour: one half on the seam
};

/// Faces of a page's texels, and what they share with the other sides of seams.
class PagePlan {
 public:
  PagePlan(const TriMesh& mesh, const Planes& planes, std::span<const Chart> charts,
           std::span<const Seam> seams, std::uint32_t page, const glm::ivec2& size);

  const glm::ivec2& size() const { return size_; }
  /// Indices of the charts on the page.
  const std::vector<std::uint32_t>& charts() const { return charts_; }
  std::span<const BandTexel> band_of_chart(std::uint32_t chart) const { return bands_[chart]; }
  /// kNoFace where no chart is.
  std::uint32_t face(const glm::ivec2& at) const { return faces_[index(at)]; }
  std::size_t index(const glm::ivec2& at) const {
    return std::size_t(at.y) * std::size_t(size_.x) + std::size_t(at.x);
  }

 private:
  void draw_chart(const TriMesh& mesh, const Planes& planes, const Chart& chart);

  glm::ivec2 size_;
  std::vector<std::uint32_t> faces_;
  std::vector<std::uint32_t> charts_;
  std::vector<std::vector<BandTexel>> bands_;  // of each chart; empty for those of other pages
};

/// The triangle where it lies on its chart: (0, 0) is the centre of the chart's first texel.
FaceInImage on_chart(const TriMesh& mesh, const Planes& planes, const Chart& chart,
                     std::uint32_t face);

}  // namespace photohull::texture

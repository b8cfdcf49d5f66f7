// Private to module texture: what a photograph shows of the mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh.h"
#include "texture/projection.h"
#include "texture/view_pixels.h"

namespace photohull::texture {

/// Pixels between a pixel and the nearest place where the photograph may show something else: an
/// outline of the mesh or of the mask, a part that stands before another, a pixel that was not
/// photographed. 1 beside it; counted up to kFullClearance.
inline constexpr int kFullClearance = 4;
/// Colours are taken from here on: a pixel that an outline runs through shows both sides, and
/// cameras and outlines are off by a pixel.
inline constexpr int kLeastClearance = 3;

/// Depths of the mesh in a photograph, and the clearance of each of its pixels.
class ViewMaps {
 public:
  ViewMaps(const TriMesh& mesh, const ViewPixels& pixels);

  int width() const { return width_; }
  int height() const { return height_; }
  bool on_image(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }
  int clearance(int x, int y) const { return clearance_[at(x, y)]; }
  /// Is surface at this depth (one over it) the one that is seen there, and clear? The clearance
  /// if so, else 0.
  int clearance_of(int x, int y, double inverse) const;

 private:
  std::size_t at(int x, int y) const { return std::size_t(y) * std::size_t(width_) + x; }
  void draw(const TriMesh& mesh, const Camera& camera);
  void draw_face(const FaceInImage& face);
  void find_edges(const ViewPixels& pixels);
  void spread_clearance();

  int width_ = 0, height_ = 0;
  double focal_ = 1;            // pixels
  std::vector<float> inverse_;  // one over the least depth; 0: nothing is there
  std::vector<std::uint8_t> clearance_;
};

}  // namespace photohull::texture

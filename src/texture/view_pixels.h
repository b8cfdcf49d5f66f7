// Private to module texture: photographs at the scale of the texture.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "core/prepared_view.h"

namespace photohull::texture {

/// The view's camera at a scale in (0, 1] of its photograph; its size is rounded to whole pixels.
Camera scaled_camera(const PreparedView& view, double scale);

/// A photograph, reduced where the texture is coarser than it is. It refers to the view.
class ViewPixels {
 public:
  /// `scale` as scaled_camera has it.
  ViewPixels(const PreparedView& view, double scale);

  const Camera& camera() const { return camera_; }
  int width() const { return image().width; }
  int height() const { return image().height; }
  /// Root of linear light.
  glm::vec3 root(int x, int y) const;
  /// The same between pixels, by Catmull-Rom's cubic in linear light; borders repeat.
  glm::vec3 root_between(const glm::dvec2& pixel) const;
  /// Was it photographed, all of it?
  bool known(int x, int y) const;
  /// Pixels from the mask's outline, positive inside; nothing without a mask.
  std::optional<float> inside(int x, int y) const;

 private:
  const ColourImage& image() const { return reduced_ ? *reduced_ : view_.image; }
  glm::vec3 linear(int x, int y) const;

  const PreparedView& view_;
  Camera camera_;
  std::optional<ColourImage> reduced_;
  glm::dvec2 scale_{1};  ///< pixels of this for one of the photograph
};

}  // namespace photohull::texture

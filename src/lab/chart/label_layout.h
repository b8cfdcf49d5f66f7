// Labels beside points, none on another.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

namespace photohull::chart {

/// Pixels, y down.
struct Rect {
  double left = 0, top = 0, right = 0, bottom = 0;
  bool overlaps(const Rect& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
  bool holds(const Rect& other) const {
    return left <= other.left && right >= other.right && top <= other.top && bottom >= other.bottom;
  }
};

struct LabelRequest {
  glm::dvec2 anchor{0.0};  ///< the point's centre
  glm::dvec2 size{0.0};    ///< the label's
};

/// For each request, in order, the centre of its label: the first free place on rings around its
/// point, of those inside `area` that cover no marker (squares of `marker` pixels about the
/// anchors), none of the `obstacles` and no label placed before. Nothing where no place within a
/// few rings is free.
std::vector<std::optional<glm::dvec2>> place_labels(const std::vector<LabelRequest>& requests,
                                                    const Rect& area, double marker,
                                                    const std::vector<Rect>& obstacles = {});

/// Size of a text in a wide sans-serif font, about right.
glm::dvec2 text_size(const std::string& text, double font_pixels);

}  // namespace photohull::chart

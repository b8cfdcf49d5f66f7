#include "lab/chart/label_layout.h"

#include <algorithm>
#include <cstring>

namespace photohull::chart {
namespace {

constexpr int kRings = 4;
constexpr double kRingStep = 9;  ///< pixels

Rect box_at(const glm::dvec2& centre, const glm::dvec2& size) {
  return {centre.x - 0.5 * size.x, centre.y - 0.5 * size.y, centre.x + 0.5 * size.x,
          centre.y + 0.5 * size.y};
}

}  // namespace

std::vector<std::optional<glm::dvec2>> place_labels(const std::vector<LabelRequest>& requests,
                                                    const Rect& area, double marker,
                                                    const std::vector<Rect>& obstacles) {
  std::vector<Rect> taken = obstacles;
  for (const LabelRequest& r : requests) taken.push_back(box_at(r.anchor, glm::dvec2(marker)));
  // Right, left, above, below, then the corners.
  constexpr int kSides[][2] = {{1, 0},  {-1, 0}, {0, -1},  {0, 1},
                               {1, -1}, {1, 1},  {-1, -1}, {-1, 1}};
  std::vector<std::optional<glm::dvec2>> places;
  for (const LabelRequest& r : requests) {
    std::optional<glm::dvec2> place;
    for (int ring = 0; ring < kRings && !place; ++ring)
      for (const auto& side : kSides) {
        const glm::dvec2 reach =
            0.5 * r.size + glm::dvec2(0.5 * marker + 3) + glm::dvec2(ring * kRingStep);
        const glm::dvec2 centre = r.anchor + glm::dvec2(side[0], side[1]) * reach;
        const Rect box = box_at(centre, r.size);
        if (!area.holds(box) ||
            std::any_of(taken.begin(), taken.end(), [&](const Rect& t) { return t.overlaps(box); }))
          continue;
        place = centre;
        taken.push_back(box);
        break;
      }
    places.push_back(place);
  }
  return places;
}

glm::dvec2 text_size(const std::string& text, double font_pixels) {
  double width = 0;  // in sizes of the font; as in DejaVu Sans, which is a wide one
  for (const unsigned char c : text) {
    if ((c & 0xc0) == 0x80) continue;  // continues a UTF-8 character
    if (std::strchr("ijl|!.,:;'()[]- ", c))
      width += 0.36;
    else if (std::strchr("mwMW%@", c))
      width += 0.92;
    else
      width += c >= 'A' && c <= 'Z' ? 0.7 : 0.62;
  }
  return {width * font_pixels, 1.2 * font_pixels};
}

}  // namespace photohull::chart

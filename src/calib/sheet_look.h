// What photographs would show of the sheet alone.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "calib/find_tags.h"
#include "calib/pose_photographs.h"
#include "core/sheet_light.h"
#include "core/sheet_look.h"
#include "sheet/draw_sheet.h"

namespace photohull {

/// By which a photograph is blurred beyond its pixels' area, near a place of it: a Gaussian's
/// deviation.
struct LocalBlur {
  glm::dvec2 at{0.0};    ///< pixels
  double deviation = 0;  ///< pixels
};

/// Of a copy of the photograph that was scaled. Gaussians make a pixel's box as wide as the edges,
/// which rise from a fifth to four fifths over 1.68 deviations.
std::vector<LocalBlur> blur_of_edges(std::span<const EdgeWidth> edges, double scale = 1);

/// Of the photograph with that index, which must be posed. `picture`: of the same sheet. `blur`:
/// between its places it is interpolated, for lenses are sharpest in the middle, and near things
/// out of focus; empty: none. `light`: on the same sheet; empty: the look has no `paper`.
SheetLook look_at_sheet(const PoseResult& result, std::size_t photo, const Sheet& sheet,
                        const SheetPicture& picture, std::span<const LocalBlur> blur,
                        const SheetLight& light = {});

/// How a photograph sees the sheet. Places are of the sheet's frame, millimetres.
struct SheetSight {
  glm::dvec3 eye{0.0};
  /// Of a place; nothing where it is not before the camera.
  std::function<std::optional<glm::dvec2>(const glm::dvec2& place)> pixel;
  /// Does the line of sight to a place pass through the box?
  std::function<bool(const glm::dvec2& place)> possible;
};

/// Of the photograph with that index, which must be posed. `result` is copied.
SheetSight sight_of_sheet(const PoseResult& result, std::size_t photo, const Sheet& sheet);

}  // namespace photohull

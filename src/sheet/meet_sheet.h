// Where lines of sight meet a sheet.
#pragma once

#include <glm/glm.hpp>
#include <optional>

namespace photohull {

/// Of a sheet that may be bent, as bend_sheet.h has it. Millimetres of the sheet's frame.
struct SheetHit {
  double t = 0;            ///< along the ray, in lengths of its direction
  glm::dvec2 place{0.0};   ///< of the flat sheet
  glm::dvec3 normal{0.0};  ///< unit, upwards
};

/// The first point beyond the origin of the ray; nothing where it goes past. The sheet has no rim
/// here. `reach`: the distance from the origin at which the sheet rises by `bend`.
std::optional<SheetHit> meet_sheet(const glm::dvec3& origin, const glm::dvec3& direction,
                                   const glm::dvec3& bend, double reach);

}  // namespace photohull

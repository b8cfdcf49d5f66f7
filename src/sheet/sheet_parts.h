// What sheets of all kinds are made by. Internal to sheet.
#pragma once

#include "sheet/sheet.h"

namespace photohull {

inline constexpr double kMargin = 8;     // mm, which printers leave free
inline constexpr double kFooter = 16;    // mm, for the bar and the words
inline constexpr double kQuiet = 0.125;  // of a tag's side: the white that its border needs around
inline constexpr double kGlued = 8;      // mm of a strip's piece that lie under the next one

/// Upright, its lower left corner there on the paper.
SheetTag tag_at(int id, const glm::dvec2& low, double side);

/// A strip around a cylinder, without the bar, on a page whose size is set.
void add_rim(const SheetOptions& options, Sheet& sheet);

}  // namespace photohull

// Points of lines joined to lines.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/silhouette.h"

namespace photohull {

/// For every point the line that it is on, a number below that of the points. Two points are
/// neighbours on a line where they are at most two pixels apart and both lines run from the one to
/// the other.
std::vector<std::uint32_t> lines_of(std::span<const LinePoint> points);

}  // namespace photohull

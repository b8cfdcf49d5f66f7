// Some of many views, chosen so that they show the object from all the sides that all of them do.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/scene.h"

namespace photohull::io {

/// The number of a selection "spread:N", N >= 2; nothing for other selections. Throws UsageError
/// for a text after "spread:" that is no such number.
std::optional<std::size_t> parse_spread(const std::string& selection);

/// Indices, ascending, of `count` of the views (all, where there are no more) by farthest-point
/// sampling [Gonzalez85]: each next view is the one that is least like those chosen before it.
/// Views differ by the direction in which they look, a unit vector, and by their place: with p from
/// the middle of the box in units of the median distance, 2 p / (1 + |p|), so that angles count
/// alike in both, distance counts too, and no view is far from all others for its distance alone.
/// Without a box the middle is the point nearest to all optical axes. Views with the whole box
/// behind them come last. The choice does not depend on the order of the views, only on their
/// names'.
std::vector<std::size_t> spread_views(const std::vector<SourceView>& views,
                                      const std::optional<Box>& box, std::size_t count);

}  // namespace photohull::io

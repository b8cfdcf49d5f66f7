// Surfels whose photographs are held together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "refine/view_choice.h"

namespace photohull::refine {

struct ViewGroup {
  std::vector<int> views;              ///< in rising order
  std::vector<std::uint32_t> surfels;  ///< in rising order, whose views are all among them
};

/// Every comparable surfel in one group, of at most `most` views (ViewChoice::kMostViews at least),
/// such that few views are in several groups: surfels with the same reference view stay together as
/// far as they can, and references are joined that need the same views. Of `views` views in all.
/// Deterministic.
std::vector<ViewGroup> group_by_views(std::span<const ViewChoice> choices, int views, int most);

}  // namespace photohull::refine

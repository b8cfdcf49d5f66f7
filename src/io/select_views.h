// The --views option. Internal to io.
#pragma once

#include <string>
#include <vector>

namespace photohull::io {

/// Indices, ascending and unique, of the names that a selection like "0-10,15,left_*" keeps.
/// Throws UsageError naming the item that is empty, out of range or matches nothing.
std::vector<std::size_t> select_views(const std::string& selection,
                                      const std::vector<std::string>& names);

}  // namespace photohull::io

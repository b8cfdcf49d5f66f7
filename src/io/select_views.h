// Lists of views, as --views and --hold-out take them.
#pragma once

#include <string>
#include <vector>

#include "core/option_word.h"

namespace photohull::io {

/// Indices, ascending and unique, of the names that a selection like "0-10,15,left_*" means; all
/// where it is empty. Throws UsageError naming the option and the item that is empty, out of range
/// or matches nothing.
std::vector<std::size_t> select_views(const std::string& selection,
                                      const std::vector<std::string>& names,
                                      const std::string& option = option_word("views"));

}  // namespace photohull::io

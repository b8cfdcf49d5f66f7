// What someone may have meant who wrote a name that does not exist.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace photohull {

/// The one of `names` that is nearest to `name` in edit distance (Levenshtein 1966), if it is near
/// enough to be meant: within two letters, or a third of the name. The first of equals.
std::optional<std::string> nearest_name(const std::string& name,
                                        const std::vector<std::string>& names);

}  // namespace photohull

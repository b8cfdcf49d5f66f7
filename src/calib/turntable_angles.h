// How far a turntable had turned for each photograph, where that is known.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/describe.h"

namespace photohull {

/// At most one of the two.
struct TurntableAngles {
  std::optional<double> step;  ///< degrees from each photograph to the next; the first is at 0
  std::vector<double> angles;  ///< degrees of each photograph

  bool given() const { return step || !angles.empty(); }
  /// Of so many photographs, degrees; none where nothing is given. Throws UsageError where both
  /// are.
  std::vector<double> of(std::size_t photographs) const;
};

void describe(Described& to, TurntableAngles& angles);

}  // namespace photohull

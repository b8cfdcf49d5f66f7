// The diagram of photohull evaluate --reliability-plot.
#pragma once

#include <string>

#include "eval/reliability.h"

namespace photohull::cli {

/// As a PNG or SVG file has it.
std::string draw_reliability(const std::string& mesh, const eval::Reliability& r, bool as_svg);

}  // namespace photohull::cli

// From results to files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "lab/chart/outcome.h"
#include "lab/chart/plan.h"

namespace photohull::chart {

/// Draws every chart of the outcomes as `folder`/NAME.svg and NAME.png (twice as many pixels) and
/// all of them as `folder`/index.html. Charts of an earlier drawing that are not among them are
/// removed. Returns the names of the files, the page first. Throws Error when a file cannot be
/// written.
std::vector<std::string> draw_charts(const Plan& plan, const std::vector<Outcome>& outcomes,
                                     const std::filesystem::path& folder, Progress& progress);

}  // namespace photohull::chart

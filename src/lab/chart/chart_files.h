// Charts as files of a folder. Private to lab.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "lab/chart/chart_set.h"

namespace photohull::chart {

/// Draws every chart as `folder`/ID.svg and ID.png (twice as many pixels) and returns the names of
/// the files. Throws Error when one cannot be written.
std::vector<std::string> write_chart_files(const std::vector<Chart>& charts,
                                           const std::filesystem::path& folder, Progress& progress);

/// Removes charts of an earlier drawing that are not among `files`.
void remove_stale_charts(const std::filesystem::path& folder,
                         const std::vector<std::string>& files);

}  // namespace photohull::chart

// Everything that a chart found, in one file.
#pragma once

#include <filesystem>
#include <vector>

#include "lab/chart/outcome.h"
#include "lab/chart/plan.h"

namespace photohull::chart {

/// results.json: the plan's title and threshold, all records, the external figures, the Pareto
/// front of each scene and of the mean, and the fitted exponents (docs/guide/charts.md). Written
/// atomically.
void write_results(const std::filesystem::path& file, const Plan& plan,
                   const std::vector<RunRecord>& records, const std::vector<Outcome>& external);

/// The records of a results.json. Throws Error for a missing, damaged or older file.
std::vector<RunRecord> read_results(const std::filesystem::path& file);

}  // namespace photohull::chart

// What a stress run found, as files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "lab/chart/stress_summary.h"

namespace photohull::chart {

/// results.json: plan, curves with breakdown points, marks, verdicts, and all samples with their
/// reports (docs/measurements/stability.md). Written atomically.
void write_stress_results(const std::filesystem::path& file, const StressPlan& plan,
                          const StressSummary& summary);

/// The samples of a results.json. Throws Error for a missing, damaged or older file.
std::vector<StressSample> read_stress_results(const std::filesystem::path& file);

/// The marks, the breakdown points, every curve's points and the verdicts as Markdown tables.
std::string stress_markdown(const StressPlan& plan, const StressSummary& summary);

/// Writes index.html, summary.md, and every chart as SVG and PNG. Returns the names of the files,
/// the page first.
std::vector<std::string> write_stress_page(const std::filesystem::path& folder,
                                           const StressPlan& plan, const StressSummary& summary,
                                           Progress& progress);

}  // namespace photohull::chart

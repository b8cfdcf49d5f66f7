// Figures of other programs, to be drawn on the same axes.
#pragma once

#include <filesystem>
#include <vector>

#include "lab/chart/outcome.h"

namespace photohull::chart {

/// Reads a JSON array of objects or a CSV file with a header. Columns: `scene` and `tool`
/// (needed); `resolution`, `cpu_s`, `wall_s`, `peak_mb`, `acc90_pct`, `comp05`, `triangles`;
/// `fDIGITS`, the F-score in percent at a threshold (f01 at 0.1 %, f025 at 0.25 %, f1 at 1 % of the
/// diagonal); `failed` (true or false). All but the first two may be absent, empty or null. Throws
/// Error that names file and row for unknown columns and for values that are no numbers or out of
/// range.
std::vector<Outcome> read_external(const std::filesystem::path& file);

}  // namespace photohull::chart

// Measurements of results, and as programs read them.
#pragma once

#include <filesystem>
#include <string>

#include "mesh/measure.h"
#include "pipeline/reconstruct.h"

namespace photohull::pipeline {

/// Of a result in memory.
Measurements measure(const Reconstruction& result, const MeasureOptions& options = {});

/// Of the mesh in a folder that `write` wrote. Throws Error where there is none, or one of its
/// files is damaged.
Measurements measure_folder(const std::filesystem::path& folder,
                            const MeasureOptions& options = {});

/// Indented by two; lengths in scene units, areas and volumes in their squares and cubes.
std::string to_json(const Measurements& measured);

/// The head of a table, and a row of it for what was measured of `name`; lines without their ends.
/// Cross-sections are not among its columns.
std::string csv_head();
std::string csv_row(const std::string& name, const Measurements& measured);

}  // namespace photohull::pipeline

// Parameters of the methods changed by name, for experiments and ablations.
#pragma once

#include <string>
#include <vector>

#include "carving/fit_stems.h"
#include "carving/missing_parts.h"
#include "carving/photo.h"
#include "mesh/sharpen_edges.h"
#include "refine/refine.h"

namespace photohull::pipeline {

/// Each assignment is NAME=VALUE with a field's name (nested ones joined by dots) and a finite
/// number, whole where the field is (0 or 1 for what is on or off). Throws UsageError naming what
/// is wrong, with the known names.
void tune(const std::vector<std::string>& assignments, carving::PhotoOptions& options);
void tune(const std::vector<std::string>& assignments, refine::RefineOptions& options,
          SharpenOptions& sharpen);

/// What all methods have: assignments whose names begin with "missing." or "stems.", which the
/// others leave alone.
void tune(const std::vector<std::string>& assignments, carving::MissingOptions& options);
void tune(const std::vector<std::string>& assignments, carving::StemOptions& options);

}  // namespace photohull::pipeline

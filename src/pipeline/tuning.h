// Parameters of the methods changed by name, for experiments and ablations.
#pragma once

#include <string>
#include <vector>

#include "carving/fit_stems.h"
#include "carving/missing_parts.h"
#include "carving/photo.h"
#include "mesh/sharpen_edges.h"
#include "pipeline/reconstruct_options.h"
#include "refine/refine.h"

namespace photohull::pipeline {

/// What can be changed of the stages: of the method's own, and of those that methods share.
struct Parameters {
  refine::RefineOptions refine;
  SharpenOptions sharpen;
  carving::PhotoOptions photo;
  carving::MissingOptions missing;
  carving::StemOptions stems;
};

/// Those that a job with this method has: its own, and those of the hull that all begin with and of
/// the mesh that all end with.
void describe(Described& to, Method method, Parameters& parameters);

/// The option of a reconstruction that sets this parameter, which tune() therefore refuses; empty
/// where there is none.
std::string option_that_sets(const std::string& parameter);

/// Each assignment is NAME=VALUE with a parameter's name and a finite number, whole where the
/// parameter is (0 or 1 for what is on or off). Throws UsageError naming what is wrong, with the
/// known names or the option that sets it, or what is out of its range.
void tune(const std::vector<std::string>& assignments, Method method, Parameters& parameters);

/// The parameters as such a job begins with them.
Parameters tuned(const ReconstructOptions& options);

/// The assignments that change results of this stage or of earlier ones.
std::vector<std::string> assignments_until(Stage last, const ReconstructOptions& options);

}  // namespace photohull::pipeline

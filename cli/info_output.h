// What `photohull info` prints.
#pragma once

#include "cameras/diagnose.h"
#include "pipeline/inspect.h"
#include "views/prepare_views.h"

namespace photohull::cli {

/// On standard output, for people. `masks` and `diagnosis`: null where they were not asked for.
void print_info_text(const pipeline::Inspection& info, const PreparedViews* masks,
                     const CameraDiagnosis* diagnosis);

/// The same as JSON; infinite and undefined numbers become null.
void print_info_json(const pipeline::Inspection& info, const PreparedViews* masks,
                     const CameraDiagnosis* diagnosis);

}  // namespace photohull::cli

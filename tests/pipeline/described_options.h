// All options of a job, and other legal values for them.
#pragma once

#include <string>

#include "core/describe.h"
#include "pipeline/tuning.h"

namespace photohull::pipeline {

/// NAME=VALUE with a legal value that is not the parameter's.
std::string assignment_of(const Option& parameter);

/// Gives the option a legal value that is not its own.
void change(const Option& option);

}  // namespace photohull::pipeline

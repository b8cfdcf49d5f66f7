// The page docs/reference/options.md.
#pragma once

#include <string>

namespace photohull::pipeline {

/// All options of a job and all parameters of its stages, from what describes them.
std::string options_reference();

}  // namespace photohull::pipeline

// The options that were given, as a command line.
#pragma once

#include <string>

#include "pipeline/reconstruct_options.h"

namespace photohull::pipeline {

/// The options that are not at their defaults, each preceded by a space: " --method hull
/// --tune 'a=1'", in the program's words (core/option_word.h).
std::string given_words(ReconstructOptions options, io::LoadSceneOptions load);

}  // namespace photohull::pipeline

// The command line's words for options.
#pragma once

#include <string>

#include "core/option_word.h"

namespace photohull::cli {

/// The flag of a described option: "--mask-offset".
std::string flag_of(const std::string& name);

/// The words of the command line, which every main() sets first.
OptionWording flag_wording();

}  // namespace photohull::cli

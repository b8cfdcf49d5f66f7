// Words for shells.
#pragma once

#include <string>

namespace photohull {

/// Text as one word of a command line, quoted for a shell where it must be.
std::string shell_word(const std::string& text);

}  // namespace photohull

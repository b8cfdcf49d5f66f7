// Which photohull this is.
#pragma once

#include <string>

namespace photohull::cli {

/// JSON: version, commit of the program's sources, versions of the libraries that it was built
/// with, and the device that --device auto takes (null where there is none).
std::string version_json();

}  // namespace photohull::cli

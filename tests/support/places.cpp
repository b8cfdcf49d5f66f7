#include "support/places.h"

namespace photohull::test {

std::string in_checkout(const std::string& path) { return PHOTOHULL_SOURCE "/" + path; }

std::string program() { return PHOTOHULL_BUILD "/photohull"; }

}  // namespace photohull::test

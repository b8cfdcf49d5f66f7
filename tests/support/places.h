// Where the tests find their data and the program.
#pragma once

#include <string>

namespace photohull::test {

/// The path of a file or folder of the checkout, by its path from the checkout's root.
std::string in_checkout(const std::string& path);

/// The path of the program that was built beside the tests.
std::string program();

}  // namespace photohull::test

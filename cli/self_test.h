// A small job whose answer is known: does the program work on this machine?
#pragma once

#include <string>

namespace photohull::cli {

struct SelfTest {
  double seconds = 0;
  double volume = 0;  ///< of the ball that was carved, of the true one's
  std::string fault;  ///< empty: all is well
};

/// Carves a ball from silhouettes that are drawn here, on a device as --device has it. What fails
/// becomes the fault.
SelfTest run_self_test(const std::string& device);

}  // namespace photohull::cli

// What is fuzzed: every function of the program that reads what others wrote.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace photohull::fuzz {

/// Feeds bytes to a reader. Returns after success and after photohull::Error; whatever else it does
/// (another exception, a crash, a hang, memory that the input's size does not justify) is a bug.
struct Target {
  std::string name;  ///< also the folder of its seeds
  std::function<void(std::string_view bytes)> run;
};

const std::vector<Target>& targets();

/// The target of that name; null where there is none.
const Target* find_target(std::string_view name);

}  // namespace photohull::fuzz

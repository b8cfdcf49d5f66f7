// Flags of the command line from described options.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "core/describe.h"

namespace photohull::cli {

/// Adds a flag for each option, or for those that are named, which must exist. They set the values
/// while the command line is parsed, and throw UsageError for what is not legal. The help tells
/// what is legal, and the values as they are now for defaults.
std::vector<CLI::Option*> add_flags(CLI::App& command, const Described& described,
                                    const std::vector<std::string>& names = {});

/// The same for a struct that describe() describes, which must outlive the command.
template <typename Options>
std::vector<CLI::Option*> add_flags_of(CLI::App& command, Options& options,
                                       const std::vector<std::string>& names = {}) {
  Described described;
  describe(described, options);
  return add_flags(command, described, names);
}

}  // namespace photohull::cli

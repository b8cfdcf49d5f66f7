// The files of a reconstruction, which appear together or not at all.
#pragma once

#include <filesystem>
#include <list>
#include <string>
#include <vector>

#include "core/atomic_file.h"

namespace photohull::pipeline {

/// Files are written one after another under temporary names, and take their final names when all
/// are complete: a full disk or Ctrl-C leaves the results of an earlier run as they were.
class ResultFiles {
 public:
  /// Makes the folder where it does not exist. Throws Error when that fails or when one of `names`
  /// could not be written there: better now than after the work.
  ResultFiles(std::filesystem::path folder, std::vector<std::string> names);

  /// A new file to write to; `name` is one of the names.
  AtomicFile& open(const std::string& name);
  /// Puts the files in place. Throws Error when that fails.
  void commit();
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::filesystem::path folder_;
  std::vector<std::string> names_;
  std::list<AtomicFile> files_;
};

}  // namespace photohull::pipeline

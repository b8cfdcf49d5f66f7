// The files of a reconstruction, which are those of one run as long as its report is there.
#pragma once

#include <filesystem>
#include <list>
#include <optional>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "core/folder_lock.h"
#include "core/progress.h"

namespace photohull::pipeline {

/// Files are written one after another under temporary names, and take their final names when all
/// are complete: a full disk or Ctrl-C leaves the results of an earlier run as they were. Names
/// cannot be taken all at once. The file opened last, the report, is the sign that they were: an
/// older one goes before the first name is taken, and the new one comes last.
class ResultFiles {
 public:
  /// Makes the folder where it does not exist, and holds it. Throws Error when that fails, when
  /// another job is at work there, or when one of `names` could not be written there: better now
  /// than after the work.
  ResultFiles(std::filesystem::path folder, std::vector<std::string> names);
  /// What was not committed goes, and a folder that it made for nothing.
  ~ResultFiles();
  ResultFiles(const ResultFiles&) = delete;
  ResultFiles& operator=(const ResultFiles&) = delete;

  /// A new file to write to; `name` is one of the names, or a file that goes with one of them.
  AtomicFile& open(const std::string& name);
  /// Puts the files in place. Notes which files an older report there lists that are not replaced.
  /// Throws Error when it fails, and says so when the folder then has files of two runs.
  void commit(Progress& progress);
  const std::filesystem::path& folder() const { return folder_; }
  const std::vector<std::string>& names() const { return names_; }

 private:
  /// In one text; empty: none.
  std::string names_left_of_older_run() const;

  std::filesystem::path folder_;
  std::vector<std::string> names_;
  bool made_ = false;  // was there no such folder before?
  std::optional<FolderLock> lock_;
  std::list<AtomicFile> files_;
};

}  // namespace photohull::pipeline

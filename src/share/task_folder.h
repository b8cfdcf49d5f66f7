// Tasks that several processes do together, by way of a folder that all of them see.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "core/progress.h"

namespace photohull::share {

/// Makes a task's result, as bytes, of what it asks for, as bytes: the same by every process.
using Perform = std::function<std::string(const std::string& task)>;

/// Some tasks of one kind.
struct Tasks {
  std::string name;  ///< of all of them; begins the names of their files
  std::size_t count = 0;
  std::function<std::string(std::size_t)> make;  ///< what the task with this number asks for
  /// Takes its result. Throws Error where that is none: it is made again.
  std::function<void(std::size_t, const std::string&)> take;
};

/// Are there tasks in a folder, which need not exist, that have no result yet?
bool has_tasks(const std::filesystem::path& folder);

/// The folder, for the process that has tasks and for those that help it. A task is a file; who
/// does it holds a lock beside it, which the system lets go of with the process (core/file_lock.h),
/// and who helped leaves the result in a third file.
class TaskFolder {
 public:
  /// Makes the folder. Throws Error where it cannot.
  explicit TaskFolder(std::filesystem::path folder);

  const std::filesystem::path& folder() const { return folder_; }

  /// Does all that nobody else does, and takes the results of the rest. Where files cannot be
  /// written it does all, warns, and returns false. Throws Cancelled, and what perform and make
  /// throw.
  bool do_all(const Tasks& tasks, const Perform& perform, Progress& progress) const;

  /// Does one task that nobody is at. False: there is none. Throws what perform throws, and Error
  /// where the result cannot be written.
  bool help(const Perform& perform) const;

 private:
  std::filesystem::path file(const std::string& stem, const char* kind) const;
  bool settle(const Tasks& tasks, std::size_t number, const Perform& perform) const;
  bool take_result(const Tasks& tasks, std::size_t number) const;
  void remove(const std::string& stem) const;

  std::filesystem::path folder_;
};

}  // namespace photohull::share

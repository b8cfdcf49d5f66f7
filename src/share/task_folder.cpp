#include "share/task_folder.h"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <system_error>
#include <thread>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/file_lock.h"
#include "core/read_file.h"

namespace photohull::share {
namespace {

namespace fs = std::filesystem;

constexpr const char *kTask = ".task", *kLock = ".lock", *kResult = ".result";
constexpr std::chrono::milliseconds kAskAgain(20);  // whether others have finished

std::string stem_of(const Tasks& tasks, std::size_t number) {
  return concat(tasks.name, "-", number);
}

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored);
}

/// Calls use(task's file) until it returns true, for those without a result. Did it?
template <typename Use>
bool any_open(const fs::path& folder, const Use& use) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const fs::path& task = entry.path();
    if (task.extension() != kTask || is_there(fs::path(task).replace_extension(kResult))) continue;
    if (use(task)) return true;
  }
  return false;
}

}  // namespace

bool has_tasks(const fs::path& folder) {
  return any_open(folder, [](const fs::path&) { return true; });
}

TaskFolder::TaskFolder(fs::path folder) : folder_(std::move(folder)) {
  std::error_code failure;
  fs::create_directories(folder_, failure);
  if (failure)
    throw Error(
        concat("the folder ", folder_.string(), " cannot be made (", failure.message(), ")"));
}

fs::path TaskFolder::file(const std::string& stem, const char* kind) const {
  return folder_ / (stem + kind);
}

bool TaskFolder::do_all(const Tasks& tasks, const Perform& perform, Progress& progress) const {
  bool offered = true;
  try {
    for (std::size_t i = 0; i < tasks.count; ++i)
      write_atomically(file(stem_of(tasks, i), kTask), tasks.make(i));
  } catch (const Error& problem) {
    progress.warn(concat("other processes cannot help: ", problem.what()));
    offered = false;
  }
  std::vector<std::size_t> left(tasks.count);
  std::iota(left.begin(), left.end(), 0);
  while (!left.empty()) {
    const std::size_t before = left.size();
    std::erase_if(left, [&](std::size_t i) {
      progress.check_cancelled();
      return settle(tasks, i, perform);
    });
    if (left.size() == before) std::this_thread::sleep_for(kAskAgain);
  }
  return offered;
}

/// False where somebody else is at it.
bool TaskFolder::settle(const Tasks& tasks, std::size_t number, const Perform& perform) const {
  if (take_result(tasks, number)) return true;
  const std::string stem = stem_of(tasks, number);
  const auto held = FileLock::if_free(file(stem, kLock));
  if (!held) return false;
  if (take_result(tasks, number)) return true;  // since
  tasks.take(number, perform(tasks.make(number)));
  remove(stem);
  return true;
}

bool TaskFolder::take_result(const Tasks& tasks, std::size_t number) const {
  const std::string stem = stem_of(tasks, number);
  if (!is_there(file(stem, kResult))) return false;
  try {
    tasks.take(number, read_whole_file(file(stem, kResult)));
  } catch (const Error&) {  // damaged, or gone since
    std::error_code ignored;
    fs::remove(file(stem, kResult), ignored);
    return false;
  }
  remove(stem);
  return true;
}

/// The task first: a process that finds none has nothing to do.
void TaskFolder::remove(const std::string& stem) const {
  std::error_code ignored;
  for (const char* kind : {kTask, kResult, kLock}) fs::remove(file(stem, kind), ignored);
}

bool TaskFolder::help(const Perform& perform) const {
  return any_open(folder_, [&](const fs::path& asked) {
    const std::string stem = asked.stem().string();
    const auto held = FileLock::if_free(file(stem, kLock));
    if (!held || is_there(file(stem, kResult))) return false;
    if (!is_there(asked)) {  // done since: the lock may be a file that was made anew
      remove(stem);
      return false;
    }
    try {
      write_atomically(file(stem, kResult), perform(read_whole_file(asked)));
    } catch (const Error&) {
      if (is_there(asked)) throw;
      return false;  // done since by who had no lock: what it needs may be gone
    }
    return true;
  });
}

}  // namespace photohull::share

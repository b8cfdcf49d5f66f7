// What of a refinement other processes can do, by way of a folder that all of them see.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/error.h"
#include "core/lists.h"
#include "core/progress.h"
#include "gpu/context.h"
#include "projtex/out_of_core.h"
#include "projtex/photographs.h"
#include "share/task_folder.h"

namespace photohull::refine {

/// Kinds of tasks.
enum class TaskKind : std::uint8_t { kMatch, kFit, kRays };

/// What every task begins with.
struct TaskHead {
  std::string job;     ///< what makes two jobs the same
  std::string device;  ///< that results are made on: another one rounds differently
  TaskKind kind = TaskKind::kMatch;
  std::uint8_t larger = 0;  ///< 1: it is about the larger photographs

  void write(ListWriter& to) const;
  static TaskHead read(ListReader& from);
};

/// The photographs of a job, in its folder.
std::filesystem::path photograph_file(const std::filesystem::path& folder, const std::string& job,
                                      bool larger);

/// The side of the process whose job it is. What is not its own outlives it.
class SharedWork {
 public:
  /// Surfels are cut into `tiles` tiles at most. `job`: as CheckpointFile has it.
  SharedWork(const std::filesystem::path& folder, std::string job, int tiles, Progress& progress);

  /// Writes the photographs for others, where their files are not there. Where they cannot be
  /// written, others cannot help: warns.
  void publish(const projtex::Photographs& photographs, projtex::OutOfCorePhotographs* larger);

  /// Names of tasks begin anew, so that those of a job that was killed are the same.
  void begin_level(int level);

  /// Can others help? Not any more once files could not be written.
  bool is_open() const { return tiles_ > 1; }
  /// Warns that from now on they cannot.
  void close(const Error& problem);

  /// How many tiles so many surfels are cut into; 1: they are matched faster than handed over.
  std::size_t tiles_of(std::size_t surfels) const;
  const std::filesystem::path& folder() const { return folder_.folder(); }
  const std::string& job() const { return job_; }

  /// The name of the tasks that come next, `kind` being said of them.
  std::string next_name(const std::string& kind);
  void do_all(const share::Tasks& tasks, const share::Perform& perform);

 private:
  share::TaskFolder folder_;
  std::string job_;
  int tiles_;
  Progress& progress_;
  int level_ = 0, step_ = 0;
};

}  // namespace photohull::refine

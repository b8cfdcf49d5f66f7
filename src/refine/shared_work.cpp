#include "refine/shared_work.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "projtex/photograph_file.h"

namespace photohull::refine {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFewestSurfels = std::size_t(1) << 10;  // of a tile

}  // namespace

void TaskHead::write(ListWriter& to) const {
  to.text(job);
  to.text(device);
  to.one(kind);
  to.one(larger);
}

TaskHead TaskHead::read(ListReader& from) {
  TaskHead out;
  out.job = from.text();
  out.device = from.text();
  out.kind = from.one<TaskKind>();
  out.larger = from.one<std::uint8_t>();
  return out;
}

fs::path photograph_file(const fs::path& folder, const std::string& job, bool larger) {
  return folder / concat(job, larger ? ".larger" : ".photographs");
}

SharedWork::SharedWork(const fs::path& folder, std::string job, int tiles, Progress& progress)
    : folder_(folder), job_(std::move(job)), tiles_(tiles), progress_(progress) {}

void SharedWork::publish(const projtex::Photographs& photographs,
                         projtex::OutOfCorePhotographs* larger) {
  const auto write = [&](bool of_larger, const auto& work) {
    const fs::path file = photograph_file(folder(), job_, of_larger);
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored)) work(file);
  };
  try {
    write(false, [&](const fs::path& file) { write_photographs(file, photographs); });
    if (larger) write(true, [&](const fs::path& file) { write_photographs(file, *larger); });
  } catch (const Error& problem) {
    close(problem);
  }
}

void SharedWork::close(const Error& problem) {
  progress_.warn(concat("other processes cannot help: ", problem.what()));
  tiles_ = 1;
}

void SharedWork::begin_level(int level) { level_ = level, step_ = 0; }

std::size_t SharedWork::tiles_of(std::size_t surfels) const {
  return std::clamp<std::size_t>(surfels / kFewestSurfels, 1, std::size_t(tiles_));
}

std::string SharedWork::next_name(const std::string& kind) {
  return concat(job_, ".", level_, "-", step_++, "-", kind);
}

void SharedWork::do_all(const share::Tasks& tasks, const share::Perform& perform) {
  if (!folder_.do_all(tasks, perform, progress_)) tiles_ = 1;
}

}  // namespace photohull::refine

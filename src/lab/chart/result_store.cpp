#include "lab/chart/result_store.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/atomic_file.h"
#include "core/error.h"

namespace photohull::chart {

namespace fs = std::filesystem;

namespace {

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw Error(concat(folder.string(), ": the folder cannot be made: ", error.message(),
                       "; choose another --out"));
}

}  // namespace

ResultStore::~ResultStore() {
  if (lock_ >= 0) ::close(lock_);
}

void ResultStore::open() {
  make_folder(folder_);
  const fs::path lock = folder_ / ".lock";
  lock_ = ::open(lock.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  if (lock_ < 0)
    throw Error(concat(folder_.string(), ": takes no files: ", std::strerror(errno),
                       "; choose another --out"));
  if (::flock(lock_, LOCK_EX | LOCK_NB) != 0)
    throw Error(concat(folder_.string(),
                       ": another photohull is at work there; wait for it or choose "
                       "another --out"));
  for (const char* name : {"runs", "scenes", "work"}) make_folder(folder_ / name);
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder_ / "work"))
    fs::remove_all(entry.path(), ignored);
}

fs::path ResultStore::make_work_folder(const std::string& id) const {
  const fs::path folder = folder_ / "work" / id;
  clear_work_folder(id);
  make_folder(folder);
  return folder;
}

void ResultStore::clear_work_folder(const std::string& id) const {
  std::error_code ignored;
  fs::remove_all(folder_ / "work" / id, ignored);
}

std::optional<RunRecord> ResultStore::load(
    const std::string& id, const std::function<void(const std::string&)>& warn) const {
  const fs::path file = folder_ / "runs" / (id + ".json");
  std::error_code status;
  if (!fs::exists(file, status)) return std::nullopt;
  try {
    RunRecord record = RunRecord::from_json(file, "", read_json(file));
    if (record.id != id) throw Error(concat(file.string(), ": id: is another run's"));
    return record;
  } catch (const Error& e) {
    warn(concat(e.what(), "; the run is repeated"));
    return std::nullopt;
  }
}

void ResultStore::save(const RunRecord& record) const {
  write_atomically(folder_ / "runs" / (record.id + ".json"),
                   record.to_json().dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace photohull::chart

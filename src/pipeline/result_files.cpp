#include "pipeline/result_files.h"

#include <algorithm>

#include "core/error.h"
#include "core/option_word.h"
#include "pipeline/read_result.h"

namespace photohull::pipeline {
namespace fs = std::filesystem;

ResultFiles::ResultFiles(fs::path folder, std::vector<std::string> names)
    : folder_(std::move(folder)), names_(std::move(names)) {
  std::error_code error;
  made_ = fs::create_directories(folder_, error);
  // A file of the folder's name may or may not count as an error.
  std::error_code ignored;
  if (error || !fs::is_directory(folder_, ignored))
    throw Error(
        concat(option_word("out", folder_.string()), ": cannot make this folder (",
               fs::exists(folder_, ignored) ? "a file of that name exists" : error.message(),
               "); choose another one"));
  lock_.emplace(folder_, "out");
  for (const std::string& name : names_) AtomicFile probe(folder_ / name);
}

ResultFiles::~ResultFiles() {
  files_.clear();
  lock_.reset();
  std::error_code ignored;  // the folder is not empty: something is in it
  if (made_) fs::remove(folder_, ignored);
}

AtomicFile& ResultFiles::open(const std::string& name) {
  return files_.emplace_back(folder_ / name);
}

std::string ResultFiles::names_left_of_older_run() const {
  std::string out;
  for (const std::string& name : listed_files(folder_)) {
    const bool new_one = std::ranges::any_of(
        files_, [&](const AtomicFile& file) { return file.target() == folder_ / name; });
    std::error_code ignored;
    if (new_one || !fs::is_regular_file(folder_ / name, ignored)) continue;
    out += (out.empty() ? "" : ", ") + name;
  }
  return out;
}

void ResultFiles::commit(Progress& progress) {
  for (const AtomicFile& file : files_) file.flush();  // what a full disk fails, before any change
  const std::string left = names_left_of_older_run();
  remove_file(files_.back().target());
  try {
    for (AtomicFile& file : files_) file.commit();
  } catch (const Error& error) {
    throw Error(concat(error.what(), " Until a run succeeds, ", folder_.string(),
                       " may hold files of two runs, and has no ",
                       files_.back().target().filename().string(), "."));
  }
  files_.clear();
  if (!left.empty())
    progress.note(
        concat(folder_.string(),
               " still holds files of an earlier run, which this one did not make: ", left));
}

}  // namespace photohull::pipeline

#include "batch/store.h"

#include <unistd.h>

#include <system_error>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/option_word.h"
#include "core/read_file.h"

namespace photohull::batch {

namespace fs = std::filesystem;

namespace {

constexpr const char *kOutcome = "outcome.json", *kLock = "lock", *kPlan = ".plan.json";

void make(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure)
    throw Error(concat("the folder ", folder.string(), " cannot be made (", failure.message(),
                       "); give another ", option_word("out")));
}

}  // namespace

Store Store::existing(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::is_regular_file(folder / ".photohull-batch" / kPlan, ignored))
    throw Error(concat(folder.string(),
                       ": no batch was planned or made in this folder; 'photohull plan' and "
                       "'photohull batch' do that"));
  return Store(folder);
}

Store::Store(fs::path folder) : folder_(std::move(folder)) { make(folder_ / ".photohull-batch"); }

fs::path Store::kept(const std::string& name) const { return folder_ / ".photohull-batch" / name; }

std::optional<std::string> Store::piece_of(const fs::path& results) const {
  if (results.empty()) return std::nullopt;
  const fs::path tidy = fs::absolute(results).lexically_normal();
  if (tidy.parent_path() != fs::absolute(folder_).lexically_normal()) return std::nullopt;
  return tidy.filename().string();
}

void Store::set_plan(const Plan& plan) const { write_atomically(kept(kPlan), to_json(plan)); }

Plan Store::plan() const { return plan_from_json(read_whole_file(kept(kPlan)), kept(kPlan)); }

std::unique_ptr<FileLock> Store::hold(const std::string& name) const {
  make(kept(name));
  return FileLock::if_free(kept(name) / kLock);
}

std::optional<Outcome> Store::outcome(const std::string& name) const {
  const fs::path file = kept(name) / kOutcome;
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return std::nullopt;
  try {
    return outcome_from_json(read_whole_file(file));
  } catch (const Error&) {  // gone since, or unreadable: it is made again
    return std::nullopt;
  }
}

void Store::set_outcome(const std::string& name, const Outcome& outcome) const {
  write_atomically(kept(name) / kOutcome, to_json(name, outcome) + "\n");
}

void Store::remove_tiles(const std::string& name) const {
  std::error_code ignored;
  fs::remove_all(tiles(name), ignored);
}

void Store::write_table(const std::string& contents) const { write_atomically(table(), contents); }

void Store::write_page(const std::string& contents) const { write_atomically(page(), contents); }

void Store::publish(const std::string& name, const std::string& from, const std::string& to) const {
  const fs::path source = results(name) / from, target = folder_ / to;
  const fs::path beside = folder_ / concat(".", to, ".", ::getpid());
  std::error_code failure;
  fs::create_hard_link(source, beside, failure);
  if (failure) fs::copy_file(source, beside, fs::copy_options::overwrite_existing, failure);
  if (!failure) fs::rename(beside, target, failure);
  if (!failure) {
    // Two names of one file stay two names when the one is renamed to the other.
    std::error_code ignored;
    fs::remove(beside, ignored);
    return;
  }
  std::error_code ignored;
  fs::remove(beside, ignored);
  throw Error(concat(target.string(), " cannot be made of ", source.string(), " (",
                     failure.message(), ")"));
}

}  // namespace photohull::batch

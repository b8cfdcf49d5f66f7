// Where a batch keeps its pieces' results, and who is at work at which.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "batch/outcome.h"
#include "batch/plan.h"
#include "core/file_lock.h"

namespace photohull::batch {

/// The folder of a batch: a folder with the results of each piece, and .photohull-batch with a
/// folder each for what became of it. Many processes may work in it at once, on one machine or on
/// several that share the file system.
class Store {
 public:
  /// Makes the folder. Throws Error where it cannot.
  explicit Store(std::filesystem::path folder);

  /// The one of a batch that was planned. Throws Error where there is none.
  static Store existing(const std::filesystem::path& folder);

  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path results(const std::string& name) const { return folder_ / name; }
  /// The piece whose results are, or will be, in the folder; nothing: it is none of this batch.
  std::optional<std::string> piece_of(const std::filesystem::path& results) const;
  void set_plan(const Plan& plan) const;
  /// Throws Error where there is none, or a damaged one.
  Plan plan() const;
  /// The right to work at a piece: nobody else has it, until it is let go or the process ends,
  /// however it does. Null: somebody else has it.
  std::unique_ptr<FileLock> hold(const std::string& name) const;
  std::optional<Outcome> outcome(const std::string& name) const;
  void set_outcome(const std::string& name, const Outcome& outcome) const;
  /// The file batch.csv, as a whole.
  void write_table(const std::string& table) const;
  std::filesystem::path table() const { return folder_ / "batch.csv"; }
  /// The file index.html, as a whole.
  void write_page(const std::string& page) const;
  std::filesystem::path page() const { return folder_ / "index.html"; }
  /// Where the piece's process lays what others can help it with.
  std::filesystem::path tiles(const std::string& name) const { return kept(name) / "tiles"; }
  /// Whatever became of the piece. What a helper has just open there stays.
  void remove_tiles(const std::string& name) const;
  /// Makes the piece's file `from` (such as volume.vdb) the batch's file `to` as well: the same
  /// file by another name, or a copy where the file system has no such names. Throws Error where it
  /// can do neither.
  void publish(const std::string& name, const std::string& from, const std::string& to) const;

 private:
  std::filesystem::path kept(const std::string& name) const;
  std::filesystem::path folder_;
};

}  // namespace photohull::batch

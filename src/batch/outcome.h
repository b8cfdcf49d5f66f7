// What became of a batch's pieces, as files and as a table.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace photohull::batch {

/// How a piece ended.
struct Outcome {
  std::string identity;  ///< of what it was made of; empty where its scene could not be read
  std::string plan;      ///< id of the plan that it was last looked at for; empty: none
  std::string scene;
  /// "good", "doubtful" or "failed" by the result's own checks; empty: there is no result.
  std::string verdict;
  std::string message;  ///< the error, or the verdict's first reason; empty if good
  int exit_code = 0;    ///< what `photohull reconstruct` had returned
  int views = 0;
  double voxel_size = 0;  ///< world units
  std::int64_t triangles = 0;
  double wall_seconds = 0, cpu_seconds = 0;
  std::int64_t peak_memory_bytes = 0;  ///< of the process while it worked at this piece

  bool has_result() const { return !verdict.empty(); }
};

std::string to_json(const std::string& name, const Outcome& outcome);
/// Without one: the name alone.
std::string to_json(const std::string& name, const std::optional<Outcome>& outcome);
/// Nothing: the text is damaged, or of another version of this file.
std::optional<Outcome> outcome_from_json(const std::string& text);

struct Row {
  std::string name;
  std::optional<Outcome> outcome;  ///< nothing: not made yet
};

/// One line each, below a line of names; comma-separated values (RFC 4180). What is not known is
/// empty.
std::string table_of(std::span<const Row> rows);

}  // namespace photohull::batch

// What a batch is to make, kept in its folder, so that other processes can go on with it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "batch/pieces.h"

namespace photohull::batch {

struct Plan {
  /// Of this writing of it: what was made by a plan of the same id need not be looked at again.
  std::string id;
  std::filesystem::path folder;  ///< absolute: where relative paths of the pieces' words begin
  /// Are the pieces frames, whose volumes get names as sequences have them (volume.0007.vdb)?
  bool sequence = false;
  int tiles = 0;              ///< that each piece's surface is cut into for others; 0: none
  std::vector<Piece> pieces;  ///< whose words say all: no option holds for all of them besides
};

/// A random one.
std::string new_plan_id();

std::string to_json(const Plan& plan);
/// Throws Error that names `file` where the text is no plan.
Plan plan_from_json(const std::string& text, const std::filesystem::path& file);

/// Numbers of pieces, counted from 1, as indices of `count` pieces: "3" or "3-7". Throws UsageError
/// for other texts and for numbers that no piece has.
std::vector<std::size_t> chosen_pieces(const std::string& text, std::size_t count);

}  // namespace photohull::batch

// Another board that pictures show, where the one that was stated does not fit them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calib/calibrate_board.h"

namespace photohull::cli {

/// Looks for boards whose columns and rows are swapped, or counted as squares where corners were
/// meant or the other way, in up to a dozen of the pictures. Says which fits to a quarter of `rms`
/// (pixels; infinite: nothing fitted) as "with --columns 6 --rows 8 ..."; empty where none does.
std::string suggest_board(const std::vector<std::filesystem::path>& images, const BoardSpec& stated,
                          LensModel lens, double rms);

}  // namespace photohull::cli

#include "other_board.h"

#include <algorithm>
#include <cstdio>

#include "core/error.h"
#include "io/image_file.h"

namespace photohull::cli {
namespace {

constexpr std::size_t kMostPictures = 12;
constexpr double kMuchBetter = 0.25;  // of the stated board's rms
constexpr double kFits = 1;           // pixels

std::vector<BoardSpec> other_boards(const BoardSpec& stated) {
  std::vector<BoardSpec> found;
  const auto add = [&](int columns, int rows) {
    BoardSpec other = stated;
    other.columns = columns, other.rows = rows;
    if (columns >= 3 && rows >= 3) found.push_back(other);
  };
  // Inner corners are one fewer than squares; charuco counts squares, and its markers tell which
  // way round it is. Grids of a chessboard are found either way round.
  if (stated.kind == BoardKind::kChess) add(stated.columns - 1, stated.rows - 1);
  if (stated.kind == BoardKind::kCharuco) {
    if (stated.columns != stated.rows) add(stated.rows, stated.columns);
    add(stated.columns + 1, stated.rows + 1);
    if (stated.columns != stated.rows) add(stated.rows + 1, stated.columns + 1);
  }
  return found;
}

std::vector<ColourImage> read_some(const std::vector<std::filesystem::path>& images) {
  std::vector<ColourImage> pictures;
  const std::size_t count = std::min(images.size(), kMostPictures);
  for (std::size_t i = 0; i < count; ++i)
    pictures.push_back(io::read_image(images[i * images.size() / count]));
  return pictures;
}

/// Pixels rms of pictures of the board; infinite where it does not fit.
double rms_of(const std::vector<ColourImage>& pictures, const BoardSpec& board, LensModel lens) {
  std::vector<BoardView> views;
  for (const ColourImage& picture : pictures)
    views.push_back(find_board(picture, board, concat("picture ", views.size())));
  CalibrateOptions options;
  options.lens = lens;
  try {
    return calibrate(views, options).all_rms;
  } catch (const Error&) {
    return INFINITY;
  }
}

}  // namespace

std::string suggest_board(const std::vector<std::filesystem::path>& images, const BoardSpec& stated,
                          LensModel lens, double rms) {
  const std::vector<BoardSpec> others = other_boards(stated);
  if (others.empty()) return {};
  const std::vector<ColourImage> pictures = read_some(images);
  double least = std::min(kFits, kMuchBetter * rms);
  const BoardSpec* best = nullptr;
  for (const BoardSpec& other : others)
    if (const double found = rms_of(pictures, other, lens); found < least) {
      least = found;
      best = &other;
    }
  if (!best) return {};
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", least);
  return concat("with --columns ", best->columns, " --rows ", best->rows, " the boards fit to ",
                text, " px: state these");
}

}  // namespace photohull::cli

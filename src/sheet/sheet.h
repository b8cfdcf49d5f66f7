// A printed sheet that an object stands on: tags around free space, and a bar to measure.
#pragma once

#include <array>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "core/describe.h"

namespace photohull {

/// A square with a code, by which a photograph's corners are told apart.
struct SheetTag {
  int id = 0;  ///< in the sheet's dictionary
  /// Of the black square: top left, top right, bottom right, bottom left, as the tag is upright.
  std::array<glm::dvec2, 4> corners;
};

/// Lengths are millimetres as printed at 100 %. The sheet's frame has its origin in the middle of
/// the free space, x to the right and y upwards on the page, z out of the paper towards the reader.
struct Sheet {
  std::string kind;                                ///< "apriltag-ring" or "charuco"
  std::string dictionary;                          ///< of the tags, a name of tag_dictionaries()
  glm::dvec2 page{0.0};                            ///< width and height
  glm::dvec2 lower_left{0.0};                      ///< the page's corner in the sheet's frame
  std::vector<SheetTag> tags;                      ///< each id once
  std::vector<std::array<glm::dvec2, 2>> squares;  ///< black ones: lower left and upper right
  std::vector<glm::dvec2> saddles;                 ///< where two black squares meet in a corner
  glm::dvec2 free_min{0.0}, free_max{0.0};         ///< where the object may stand
  glm::dvec2 bar_from{0.0}, bar_to{0.0};           ///< ends of the bar that is to be measured

  double bar_length() const { return glm::length(bar_to - bar_from); }
};

enum class Paper { kA4, kA3, kLetter };
const char* to_string(Paper paper);

enum class SheetKind {
  kTagRing,  ///< AprilTags around the free space [Olson11]
  kCharuco   ///< a chessboard around it, with tags in its white squares
};
const char* to_string(SheetKind kind);

struct SheetOptions {
  Paper paper = Paper::kA4;
  SheetKind kind = SheetKind::kTagRing;
  double tag = 0;    ///< side of a tag, or of a chessboard's square, mm; 0: by the paper
  int first_id = 0;  ///< of the tags, which count on from there
};

void describe(Described& to, SheetOptions& options);

/// Tags of the family 36h11 [Olson11] along the page's edges, the bar below. Throws UsageError
/// where tags of that size leave no free space, or where there are not so many tags.
Sheet make_sheet(const SheetOptions& options);

/// Names of the dictionaries that tags may be of: OpenCV's, "apriltag-36h11" first.
std::vector<std::string> tag_dictionaries();
/// OpenCV's number of a dictionary. Throws Error for an unknown name.
int tag_dictionary(const std::string& name);

/// Cells of a tag, its black border included, row by row from the top: true where it is white.
std::vector<std::vector<bool>> tag_cells(const std::string& dictionary, int id);

/// The JSON file that describes the sheet.
std::string sheet_text(const Sheet& sheet);
/// Reads it back. Throws Error naming the file and the field that is missing or wrong.
Sheet read_sheet(const std::filesystem::path& file);

}  // namespace photohull

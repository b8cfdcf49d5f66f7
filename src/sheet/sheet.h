// A printed sheet that an object stands on: tags around free space, and a bar to measure. Or a
// strip of tags around a turntable or a pot.
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

/// A piece of a strip that is printed on several lines of a page.
struct StripPiece {
  double from = 0, to = 0;  ///< mm along the strip
  glm::dvec2 low{0.0};      ///< where its lower left corner is on the page, mm from that one's
};

/// Lengths are millimetres as printed at 100 %. The sheet's frame has its origin in the middle of
/// the free space, x to the right and y upwards on the page, z out of the paper towards the reader.
///
/// A strip around a cylinder (a turntable's edge, a pot's rim) has a diameter. Places on its paper
/// are then x along the strip, counterclockwise as seen from above, and y up from its lower edge.
/// Its frame is the cylinder's: z is the axis, upwards, z = 0 the plane of the strip's lower edge,
/// and the strip's left end is in the direction of x. The free space is the square around the
/// cylinder, the page has its own frame, and there are no squares and saddles.
struct Sheet {
  std::string kind;                                ///< "apriltag-ring", "charuco" or "rim"
  std::string dictionary;                          ///< of the tags, a name of tag_dictionaries()
  glm::dvec2 page{0.0};                            ///< width and height
  glm::dvec2 lower_left{0.0};                      ///< the page's corner in the sheet's frame
  std::vector<SheetTag> tags;                      ///< each id once
  std::vector<std::array<glm::dvec2, 2>> squares;  ///< black ones: lower left and upper right
  std::vector<glm::dvec2> saddles;                 ///< where two black squares meet in a corner
  glm::dvec2 free_min{0.0}, free_max{0.0};         ///< where the object may stand
  glm::dvec2 bar_from{0.0}, bar_to{0.0};           ///< ends of the bar that is to be measured

  double diameter = 0;             ///< of the cylinder without paper; 0: the sheet is flat
  double strip = 0;                ///< height of the strip around a cylinder
  std::vector<StripPiece> pieces;  ///< to be cut out, of a strip that was made and not read

  double bar_length() const { return glm::length(bar_to - bar_from); }
  bool is_flat() const { return diameter == 0; }
  /// Where a place on the paper is in the sheet's frame.
  glm::dvec3 at(const glm::dvec2& on_paper) const;
  /// The other way round, of a place on the cylinder, from 0 to a turn.
  glm::dvec2 on_paper(const glm::dvec3& place) const;
};

enum class Paper { kA4, kA3, kLetter };
const char* to_string(Paper paper);

enum class SheetKind {
  kTagRing,  ///< AprilTags around the free space [Olson11]
  kCharuco,  ///< a chessboard around it, with tags in its white squares
  kRim       ///< a strip of AprilTags to be wrapped once around a cylinder
};
const char* to_string(SheetKind kind);

struct SheetOptions {
  Paper paper = Paper::kA4;
  SheetKind kind = SheetKind::kTagRing;
  double tag = 0;       ///< side of a tag, or of a chessboard's square, mm; 0: by the paper
  int first_id = 0;     ///< of the tags, which count on from there; of a strip 0: 300
  double diameter = 0;  ///< of the cylinder that a strip is for, mm
};

void describe(Described& to, SheetOptions& options);

/// Tags of the family 36h11 [Olson11] along the page's edges, or of a strip evenly around the
/// cylinder, the bar below. Throws UsageError where tags of that size leave no free space, are more
/// than an eighth of the diameter, or do not fit on the page, and where there are not so many tags.
Sheet make_sheet(const SheetOptions& options);

/// Throws UsageError where the bar, measured in millimetres, is twice as long as it should be, or
/// half as long; 0: it was not measured.
void check_bar(const Sheet& sheet, double bar);

/// A strip as it is printed: all lengths on its paper by the bar as measured, mm (0: as stated),
/// which is its bar then; the cylinder is as large as it is. A flat sheet stays as it is described.
/// Throws as check_bar does.
Sheet as_printed(const Sheet& sheet, double bar);

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

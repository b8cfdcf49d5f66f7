// The tags of a printed sheet in a photograph.
#pragma once

#include <string>
#include <vector>

#include "calib/calibrate_board.h"
#include "sheet/sheet.h"

namespace photohull {

/// Pixels over which a photograph's edges rise from a fifth to four fifths, near a place of it.
struct EdgeWidth {
  glm::dvec2 at{0.0};  ///< pixels
  double width = 0;
};
using PhotoEdges = std::vector<std::vector<EdgeWidth>>;  ///< of each photograph

/// What a photograph shows of a sheet. Points come four to a tag, in the order of its corners, and
/// after them the saddle points one by one, in millimetres of the sheet's frame: their z is 0, but
/// for a strip around a cylinder.
struct SheetView {
  BoardView board;
  std::vector<int> tags;  ///< ids of the tags whose corners `board` begins with
  int foreign = 0;        ///< tags of the dictionary that the sheet does not have
  int twice = 0;          ///< tags of the sheet that were seen in two places, and count nowhere
  bool mirrored = false;  ///< no tag, but there are some in the mirrored photograph
  std::vector<EdgeWidth> edges;  ///< of the same tags, at their middles

  /// The median of `edges`, pixels; 0: no tags.
  double edge_width() const;

  std::size_t tag_points() const { return 4 * tags.size(); }
};

/// OpenCV's ArUco detector finds the tags [GarridoJurado14]. Each edge is then measured in linear
/// light, where blur moves it to neither side: across it every profile's area tells where it lies,
/// a line is fitted to all of them, and corners are where lines meet. A tag whose edges are not
/// straight or not there, as where something covers it, is left out. Throws Error where OpenCV
/// fails; no points where no tag is found.
SheetView find_tags(const ColourImage& image, const Sheet& sheet, const std::string& name);

}  // namespace photohull

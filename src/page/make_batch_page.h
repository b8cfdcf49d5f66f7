// All results of a batch as one HTML page (docs/guide/batch.md).
#pragma once

#include <span>
#include <string>

namespace photohull::page {

/// A piece as the page shows it.
struct ShownPiece {
  /// JSON, with `name` and, where it was made or tried, `verdict` ("" where there is no result),
  /// `message`, `views`, `voxel_size`, `triangles`, `wall_seconds` and `cpu_seconds`.
  std::string figures;
  bool preview = false, page = false;  ///< are preview.png and report.html in the piece's folder?
};

/// One file, for a browser of 2023 or later: a mark for each piece in this order, and cards with
/// pictures, which are those in the pieces' folders beside the page. Texts are shown as they are
/// and are never read as HTML or as a script. Throws Error where figures are not JSON.
std::string make_batch_page(std::span<const ShownPiece> pieces);

}  // namespace photohull::page

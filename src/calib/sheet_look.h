// What photographs would show of the sheet alone.
#pragma once

#include "calib/pose_photographs.h"
#include "core/sheet_look.h"
#include "sheet/draw_sheet.h"

namespace photohull {

/// Deviation of the Gaussian that makes a pixel's box as wide as the edges that were measured: they
/// rise from a fifth to four fifths over 1.68 deviations. Pixels.
double blur_of_edges(double edge_width);

/// Of the photograph with that index, which must be posed. `picture`: of the same sheet. `blur`: a
/// Gaussian's deviation in pixels, by which the photograph is blurred beyond its pixels' area.
SheetLook look_at_sheet(const PoseResult& result, std::size_t photo, const Sheet& sheet,
                        const SheetPicture& picture, double blur);

}  // namespace photohull

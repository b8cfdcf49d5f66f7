// What photographs would show of the sheet alone.
#pragma once

#include "calib/pose_photographs.h"
#include "core/sheet_look.h"
#include "sheet/draw_sheet.h"

namespace photohull {

/// Of the photograph with that index, which must be posed. `picture`: of the same sheet. `blur`: a
/// Gaussian's deviation in pixels, by which the photograph is blurred beyond its pixels' area.
SheetLook look_at_sheet(const PoseResult& result, std::size_t photo, const Sheet& sheet,
                        const SheetPicture& picture, double blur);

}  // namespace photohull

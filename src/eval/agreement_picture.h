// A picture of where a mesh fails to predict a photograph.
#pragma once

#include <string>

#include "core/prepared_view.h"
#include "eval/error_image.h"
#include "eval/photo_agreement.h"

namespace photohull::eval {

/// Four panels side by side, cut to the foreground and the mesh's projection: the photograph; the
/// prediction (magenta where no lending view sees the surface); their difference (red: predicted
/// too bright, blue: too dark, full at 0.2 of the square root of linear light; green: the mesh does
/// not cover the foreground, yellow: it covers background); the ZNCC of the windows (white 1, black
/// 0 and below; slate where nothing is judged). `title` is ASCII. `view` is the one of the maps.
RgbImage draw_agreement(const PreparedView& view, const PhotoMaps& maps, const std::string& title);

}  // namespace photohull::eval

// Private to module texture: colours beyond charts.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh_texture.h"

namespace photohull::texture {

/// Gives texels that show nothing the mean colour of those nearby that do, from ever larger squares
/// around: coarser mip levels mix them with charts. All keep theirs where none shows anything.
void spread_colours(const std::vector<std::uint8_t>& shown, RgbImage& page);

}  // namespace photohull::texture

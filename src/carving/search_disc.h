// r-consistency [Kutulakos00]: views agree on a voxel when each shows it somewhere within r pixels
// of where its camera has it. Calibration errors up to r then do not carve.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace photohull::carving {

inline constexpr double kMaxSearchRadius = 4;  // pixels

/// Where a view looks for a voxel, pixels from its projection: the projection itself first, then
/// hexagonal rings out to `radius` (in [0, kMaxSearchRadius]), at most a pixel apart.
std::vector<glm::dvec2> search_disc(double radius);

/// Lines of "#define" for the kernels that sample layers and score columns; none for one offset.
std::string search_defines(const std::vector<glm::dvec2>& offsets);

}  // namespace photohull::carving

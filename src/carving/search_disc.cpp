// After: K. Kutulakos, "Approximate N-view stereo", ECCV 2000.
#include "carving/search_disc.h"

#include <cmath>
#include <numbers>
#include <sstream>

#include "core/error.h"

namespace photohull::carving {

std::vector<glm::dvec2> search_disc(double radius) {
  PHOTOHULL_CHECK(radius >= 0 && radius <= kMaxSearchRadius);
  std::vector<glm::dvec2> offsets{{0, 0}};
  const int rings = int(std::ceil(radius));
  for (int ring = 1; ring <= rings; ++ring)
    for (int i = 0; i < 6 * ring; ++i) {
      const double angle = 2 * std::numbers::pi * i / (6 * ring);
      offsets.push_back(radius * ring / rings * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
  return offsets;
}

std::string search_defines(const std::vector<glm::dvec2>& offsets) {
  if (offsets.size() <= 1) return {};
  std::ostringstream out;
  out.precision(9);
  out << std::fixed << "#define SEARCH_TAPS " << offsets.size() << "\n#define SEARCH_OFFSETS ";
  for (std::size_t i = 0; i < offsets.size(); ++i)
    out << (i ? ", " : "") << "vec2(" << offsets[i].x << ", " << offsets[i].y << ")";
  out << "\n";
  return out.str();
}

}  // namespace photohull::carving

// Pull and push, after Gortler et al., "The Lumigraph", SIGGRAPH 1996 [Gortler96].
#include "texture/spread_colours.h"

#include <algorithm>
#include <glm/glm.hpp>

namespace photohull::texture {
namespace {

/// Sums of colours, and how many there are (w).
struct Level {
  int width = 0, height = 0;
  std::vector<glm::vec4> texels;

  glm::vec4& at(int x, int y) { return texels[std::size_t(y) * width + x]; }
};

glm::vec4 mean_of(const glm::vec4& sum) { return sum.w > 0 ? sum / sum.w : glm::vec4(0); }

Level half_of(const std::vector<std::uint8_t>& shown, const RgbImage& page) {
  Level out{(page.width + 1) / 2, (page.height + 1) / 2, {}};
  out.texels.resize(std::size_t(out.width) * out.height, glm::vec4(0));
  for (int y = 0; y < page.height; ++y)
    for (int x = 0; x < page.width; ++x) {
      const std::size_t i = std::size_t(y) * page.width + x;
      if (shown[i])
        out.at(x / 2, y / 2) +=
            glm::vec4(page.rgb[3 * i], page.rgb[3 * i + 1], page.rgb[3 * i + 2], 1);
    }
  return out;
}

/// Means count alike, or charts far away would outweigh those nearby.
Level half_of(Level& fine) {
  Level out{(fine.width + 1) / 2, (fine.height + 1) / 2, {}};
  out.texels.resize(std::size_t(out.width) * out.height, glm::vec4(0));
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < fine.width; ++x) out.at(x / 2, y / 2) += mean_of(fine.at(x, y));
  return out;
}

}  // namespace

void spread_colours(const std::vector<std::uint8_t>& shown, RgbImage& page) {
  std::vector<Level> levels{half_of(shown, page)};
  while (levels.back().width > 1 || levels.back().height > 1)
    levels.push_back(half_of(levels.back()));
  for (std::size_t l = levels.size(); l-- > 1;)
    for (int y = 0; y < levels[l - 1].height; ++y)
      for (int x = 0; x < levels[l - 1].width; ++x)
        if (glm::vec4& texel = levels[l - 1].at(x, y); texel.w == 0)
          texel = levels[l].at(x / 2, y / 2);
  for (int y = 0; y < page.height; ++y)
    for (int x = 0; x < page.width; ++x) {
      const std::size_t i = std::size_t(y) * page.width + x;
      if (shown[i]) continue;
      const glm::vec4 colour = mean_of(levels[0].at(x / 2, y / 2));
      for (int c = 0; c < 3; ++c) page.rgb[3 * i + std::size_t(c)] = std::uint8_t(colour[c] + 0.5f);
    }
}

}  // namespace photohull::texture

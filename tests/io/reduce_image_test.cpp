// Pictures in memory made smaller, against files read smaller.
#include "io/reduce_image.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "io/image_file.h"
#include "support/scratch_folder.h"

namespace photohull::io {
namespace {

std::vector<std::uint8_t> noise(std::size_t count) {
  std::vector<std::uint8_t> bytes(count);
  std::uint32_t state = 1;
  for (std::uint8_t& byte : bytes)
    byte = std::uint8_t((state = state * 1664525u + 1013904223u) >> 24);
  return bytes;
}

TEST(ReduceImage, GivesWhatReadingTheFileSmallerGives) {
  const ScratchFolder folder;
  for (const int channels : {3, 4}) {
    write_png(folder / "a.png", 37, 23, channels, noise(37 * 23 * std::size_t(channels)));
    const ColourImage whole = read_image(folder / "a.png");
    for (const double scale : {1.0, 0.5, 0.3, 0.01}) {
      const ColourImage memory = reduced(whole, scale), file = read_image(folder / "a.png", scale);
      EXPECT_EQ(memory.width, file.width);
      EXPECT_EQ(memory.height, file.height);
      EXPECT_EQ(memory.has_alpha, file.has_alpha);
      EXPECT_EQ(memory.bytes, file.bytes) << scale;
    }
  }
}

TEST(ReduceImage, MasksKeepTheirCoverage) {
  const ScratchFolder folder;
  write_png(folder / "m.png", 41, 29, 1, noise(41 * 29));
  const Mask whole = read_mask(folder / "m.png");
  for (const glm::dvec2 scale : {glm::dvec2(1), glm::dvec2(0.5), glm::dvec2(0.25, 0.7)}) {
    const Mask memory = reduced(whole, scale), file = read_mask(folder / "m.png", scale);
    EXPECT_EQ(memory.width, file.width);
    EXPECT_EQ(memory.height, file.height);
    EXPECT_EQ(memory.coverage, file.coverage) << scale.x;
  }
  EXPECT_TRUE(reduced(Mask(), glm::dvec2(0.5)).empty());
}

}  // namespace
}  // namespace photohull::io

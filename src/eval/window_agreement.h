// How alike two pictures are, window by window.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

namespace photohull::eval {

/// Two pictures of the same size, row-major; values in which noise is about even.
struct PicturePair {
  int width = 0;
  int height = 0;
  std::vector<glm::vec3> photo, prediction;
  std::vector<std::uint8_t> counts;     ///< pixels of the photograph that are to be judged
  std::vector<std::uint8_t> predicted;  ///< pixels where there is a prediction
};

/// For every pixel the zero-mean normalised cross-correlation, in [-1, 1], of the windows of
/// `window` x `window` pixels around it:
///
///   sum (a - mean a) (b - mean b) / (n sqrt(max(var a, floor) max(var b, floor)))
///
/// over the pixels of the window that count and are predicted, all three channels together, each
/// with means of its own; variances are means over n, pixels times channels. 0 where the pixel, or
/// more than half of those that count in its window, are not predicted. NaN, whatever the
/// prediction, where the pixel does not count or its window tells nothing: where less than a
/// quarter of it counts, or where the photograph's variance in it is below `floor`.
/// Which pixels are judged thus depends on the photograph alone. `row_done` is called, from any
/// thread, after each row and may throw.
std::vector<float> window_agreement(
    const PicturePair& pair, int window, double floor,
    const std::function<void()>& row_done = [] {});

}  // namespace photohull::eval

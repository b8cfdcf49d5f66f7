// Pictures averaged to fewer pixels, row by row. Internal to io.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <vector>

namespace photohull::io {

/// Averages over the area of each pixel of the smaller picture: the box filter that mip chains are
/// made with, for any ratio. Pixels at the right and lower border, which may stand out of the
/// picture, are means of what is in it.
class AreaAverage {
 public:
  /// Called with every row of the smaller picture, from the top.
  using Emit = std::function<void(const float* row)>;

  /// `width` x `height` is the extent of the rows to come in their own pixels; their last one may
  /// stand out of it. `ratio`: sides of a smaller pixel in them, x and y, above 0.
  AreaAverage(double width, double height, const glm::dvec2& ratio, int channels, Emit emit);

  int width() const { return width_; }
  int height() const { return height_; }
  /// The next row, ceil(width) pixels of interleaved channels.
  void add(const float* row);

 private:
  /// What a smaller pixel takes of the row: its first pixel, and weights of that and the next ones.
  struct Span {
    int first = 0;
    std::vector<float> weights;
  };

  double source_height_, ratio_;  // of rows
  int channels_, width_, height_;
  Emit emit_;
  std::vector<Span> spans_;
  std::vector<float> narrow_, sum_;
  double top_ = 0, weight_ = 0;
  int row_ = 0;
};

}  // namespace photohull::io

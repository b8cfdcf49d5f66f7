// JPEG files decoded at a half, a quarter or an eighth, row by row. Internal to io.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace photohull::io {

/// The reduced inverse DCT of libjpeg: of every block of 8 x 8 coefficients the lowest n x n, so
/// that a pixel is about the mean of 8/n x 8/n of the file's in stored (not linear) values, for a
/// fraction of the whole decoding's time. Pixel (0, 0) covers the file's top-left ones.
class JpegRows {
 public:
  /// `reduction` is 1, 2, 4 or 8. The file must be grey or have three components.
  JpegRows(const std::filesystem::path& path, int reduction);
  ~JpegRows();

  /// Of the reduced picture, rounded up; 0 when the file could not be opened.
  int width() const;
  int height() const;
  /// The next row as RGBA with alpha 255. False at damage; error() says which.
  bool read_row(std::uint8_t* rgba);
  /// After the last row: was the file whole?
  bool finish();
  const std::string& error() const;
  /// Was it for want of memory, not for damage?
  bool out_of_memory() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace photohull::io

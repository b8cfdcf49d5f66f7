// Pixels in main memory.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/scene.h"
#include "core/silhouette.h"

namespace photohull {

/// RGBA pixels, row-major from the top-left, in one of the two encodings that the GPU samples to
/// linear light: 8-bit sRGB (4 bytes a pixel) for 8-bit sources, and linear half float (8 bytes a
/// pixel) for 16-bit and floating-point sources. Alpha is linear in both: 1 where the file has
/// none.
struct ColourImage {
  enum class Encoding { kSrgb8, kLinearHalf };

  int width = 0;
  int height = 0;
  Encoding encoding = Encoding::kSrgb8;
  bool has_alpha = false;           ///< the file itself had an alpha channel
  std::vector<std::uint8_t> bytes;  ///< width * height * bytes_per_pixel()

  std::size_t bytes_per_pixel() const { return encoding == Encoding::kSrgb8 ? 4 : 8; }
  /// Linear-light RGBA of one pixel.
  glm::vec4 linear(int x, int y) const;
};

/// Foreground coverage of each pixel: 0 background, 255 object. Empty: nothing is known.
struct Mask {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> coverage;  ///< width * height

  bool empty() const { return coverage.empty(); }
};

/// What carving goes by of a view. Without a mask all of it is empty.
struct ViewSilhouette {
  SilhouetteDistance distance;   ///< of `widened` where there is one, else of the mask
  std::vector<LinePoint> lines;  ///< parts of the mask narrower than about two pixels
  /// The mask with room around its lines and its outline, and with what other views put into it;
  /// empty where nothing changed.
  Mask widened;
  /// Coverage is the chance that the object is there (masks that were made from the background),
  /// not the share of a pixel.
  bool likelihood = false;
};

/// A photograph ready for carving: undistorted, with its mask.
struct View {
  std::string name;
  Camera camera;  ///< pinhole; intrinsics match the image's size
  ColourImage image;
  Mask mask;
  /// Share of fine detail beside views of the same (views/sharpness.h): 1 as sharp as they are.
  double sharpness = 1;
  SourceView source{};  ///< the photograph as the scene lists it, at the scale that it was read at
  ViewSilhouette silhouette{};
};

/// sRGB transfer function (IEC 61966-2-1), encoded value in [0, 1] to linear light and back.
double linear_from_srgb(double encoded);
double srgb_from_linear(double linear);

}  // namespace photohull

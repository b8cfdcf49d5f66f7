// Image files to pixels and back. Safe to call from several threads at once; each call decodes on
// its own thread only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/atomic_file.h"
#include "core/file_mask.h"
#include "core/image.h"
#include "core/rgb_image.h"

namespace photohull::io {

/// No image of more pixels is decoded: the guard against files that claim absurd sizes.
inline constexpr std::int64_t kMaxImagePixels = std::int64_t(1) << 28;

struct ImageSize {
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  /// EXIF orientation, 1 to 8: 1 as stored or not stated; 5 to 8 want the sides swapped.
  int orientation = 1;
};

/// Size of an image from its header; nothing is decoded. Throws Error as read_image does.
ImageSize read_image_size(const std::filesystem::path& path);

/// Pixels of the largest of these images, by their headers. What cannot be read counts nothing:
/// reading the image itself tells why.
double pixels_of_largest(std::span<const std::filesystem::path> images);

/// Decodes PNG, JPEG, TIFF, OpenEXR, BMP, PNM, and where OpenImageIO can WebP and AVIF; grey, grey
/// + alpha, RGB or RGBA (further channels are ignored). Pixels stay as they are stored: no EXIF
/// rotation, no colour profile.
///
///   8-bit          kSrgb8, the file's values verbatim
///   16-bit         kLinearHalf; decoded from sRGB unless the file declares linear light
///   half, float    kLinearHalf; taken as linear; NaN and infinities become 0, and finite values
///                  beyond the range of half are clamped to it
///
/// Alpha is straight: where a file stores colours multiplied by alpha they are divided by it.
/// Throws Error naming the file when it is missing, damaged, of another pixel type, cropped
/// (OpenEXR data window unlike the display window) or larger than kMaxImagePixels; MemoryError
/// where there is no memory for its pixels.
ColourImage read_image(const std::filesystem::path& path);

/// Decodes a mask from an image of any channel count: its alpha where that varies over the image,
/// else the luminance of its colours (stored values, Rec. 709 weights, no transfer function).
/// Integer values none of which is above 1 are labels: 1 becomes 255 (FileMask::from_ones).
/// Throws Error as read_image does.
FileMask read_mask(const std::filesystem::path& path);

/// The same at a scale in (0, 1] (core/image_scale.h): what the file's pixels are in the mean over
/// each of the result's, of colours in linear light. Strips of the file are held at a time, not all
/// of it (unless its compression asks for that: interlaced PNG, progressive JPEG). JPEG files are
/// decoded at 1/2, 1/4 or 1/8 by their DCT where that is at least as much as is asked for, which
/// takes the mean in stored values; the rest is averaged.
ColourImage read_image(const std::filesystem::path& path, double scale);
/// Coverage in the mean over each of the result's pixels, so that its sum over the object is kept.
FileMask read_mask(const std::filesystem::path& path, double scale);
/// Of scales for x and y, above 0: masks that are scaled copies of their photographs' size.
FileMask read_mask(const std::filesystem::path& path, const glm::dvec2& scale);

/// Writes an 8-bit PNG; `bytes` holds width * height * channels values, row-major from the
/// top-left; 1 to 4 channels: grey, grey + alpha, RGB, RGBA, alpha straight. The file appears whole
/// or not at all. Throws Error when it cannot be written.
void write_png(const std::filesystem::path& path, int width, int height, int channels,
               std::span<const std::uint8_t> bytes);
/// The same, for the caller to commit.
void write_png(AtomicFile& file, int width, int height, int channels,
               std::span<const std::uint8_t> bytes);
void write_png(AtomicFile& file, const RgbImage& picture);
/// The bytes of that file.
std::vector<std::uint8_t> encode_png(int width, int height, int channels,
                                     std::span<const std::uint8_t> bytes);

}  // namespace photohull::io

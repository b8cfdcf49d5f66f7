// Image files opened by OpenImageIO, and what their channels mean. Internal to io; includes
// OpenImageIO's headers.
#pragma once

#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace photohull::io {

/// Which of the file's channels matter: `colours` (1 or 3) from channel 0, and an alpha channel.
struct Layout {
  int colours = 0;
  int alpha = -1;              ///< channel index; -1: none
  bool premultiplied = false;  ///< colours are stored multiplied by alpha
  int channels = 0;            ///< channels to read, from channel 0
};

struct OpenImage {
  std::filesystem::path path;
  std::unique_ptr<OIIO::ImageInput> input;
  OIIO::ImageSpec spec;
  Layout layout;

  std::size_t pixels() const { return std::size_t(spec.width) * spec.height; }
};

/// Callers decode many images side by side; threads inside each would only get in the way.
void keep_to_one_thread();

/// OpenImageIO's messages may come as several lines, one a plug-in.
std::string one_line(std::string text);

/// Reads the header. Throws Error as read_image does.
OpenImage open_image(const std::filesystem::path& path);

/// The same for an image that will be decoded: throws Error where the file plainly ends too early,
/// too, which no decoder has to find out.
OpenImage open_whole_image(const std::filesystem::path& path);

/// Throws Error: decoders say that the file is not whole.
[[noreturn]] void damaged(const OpenImage& file, const std::string& detail);

/// Throws Error: pixels of a type that is not read.
[[noreturn]] void unsupported(const OpenImage& file);

/// Throws MemoryError: there is no memory for the file's pixels.
[[noreturn]] void out_of_memory(const OpenImage& file);

/// Does the file say that its values are linear light?
bool declares_linear(const OIIO::ImageSpec& spec);

/// Stored colour divided by stored alpha, both up to `maximum`.
std::uint32_t unpremultiplied(std::uint32_t colour, std::uint32_t alpha, std::uint32_t maximum);

/// 0 for NaN and infinities.
float finite_or_zero(float value);

/// Of stored values, by the weights of Rec. 709.
std::uint8_t luminance(std::uint8_t r, std::uint8_t g, std::uint8_t b);

}  // namespace photohull::io

// SVG documents as PNG files.
#pragma once

#include <filesystem>
#include <string>

namespace photohull::chart {

/// An SVG document as the bytes of a PNG of exactly `width` x `height` pixels on white, drawn with
/// librsvg. Throws Error when the document is not SVG.
std::string to_png(const std::string& svg, int width, int height);

/// Draws an SVG document to a PNG of exactly `width` x `height` pixels on white, with librsvg, and
/// writes it atomically. Throws Error when the document is not SVG or the file cannot be written.
void write_png(const std::string& svg, int width, int height, const std::filesystem::path& path);

}  // namespace photohull::chart

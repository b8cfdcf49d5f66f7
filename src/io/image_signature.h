// Which decoder an image file is for. Internal to io.
#pragma once

#include <filesystem>
#include <string>

namespace photohull::io {

/// "PNG, JPEG, ... can be read": which formats this build of OpenImageIO has decoders for.
std::string known_images();

/// OpenImageIO's name of the format that the file's first bytes tell: png, jpeg, tiff, openexr,
/// bmp, pnm, webp or heif (AVIF, HEIC). Left to itself, OpenImageIO would try the decoders of
/// dozens of formats on a file that is none of these. Checks an OpenEXR file's header too, whose
/// decoder asks for whatever memory an attribute claims. Throws Error naming the file for all
/// others.
const char* image_format(const std::filesystem::path& path);

}  // namespace photohull::io

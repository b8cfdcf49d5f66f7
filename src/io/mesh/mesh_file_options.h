// What can be chosen about the files that meshes are written in.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/describe.h"
#include "core/mesh_texture.h"

namespace photohull {

enum class TextureFormat { kPng, kJpeg };
enum class LengthUnit { kMillimetre, kCentimetre, kMetre, kInch };

const char* to_string(TextureFormat format);
const char* to_string(LengthUnit unit);

/// What each is, with its legal values, describe() tells.
struct MeshFileOptions {
  bool compress = false;
  TextureFormat texture_format = TextureFormat::kPng;
  std::optional<LengthUnit> unit;  ///< of the scene; nothing: not known

  /// Of a scene unit; 1 where it is not known.
  double metres() const;
};

void describe(Described& to, MeshFileOptions& options);

/// A page as an image file.
struct PageImage {
  std::vector<std::uint8_t> bytes;
  const char* type;  ///< "image/png"
};

PageImage encode_page(const RgbImage& page, TextureFormat format);
/// "png" or "jpg".
const char* extension_of(TextureFormat format);

}  // namespace photohull

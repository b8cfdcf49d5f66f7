#include "io/mesh/mesh_file_options.h"

#include <array>

#include "io/encode_jpeg.h"
#include "io/image_file.h"

namespace photohull {
namespace {

constexpr int kJpegQuality = 92;

}  // namespace

const char* to_string(TextureFormat format) {
  return format == TextureFormat::kPng ? "png" : "jpeg";
}

const char* to_string(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::kMillimetre:
      return "mm";
    case LengthUnit::kCentimetre:
      return "cm";
    case LengthUnit::kMetre:
      return "m";
    case LengthUnit::kInch:
      return "inch";
  }
  return "";
}

double MeshFileOptions::metres() const {
  if (!unit) return 1;
  switch (*unit) {
    case LengthUnit::kMillimetre:
      return 0.001;
    case LengthUnit::kCentimetre:
      return 0.01;
    case LengthUnit::kMetre:
      return 1;
    case LengthUnit::kInch:
      return 0.0254;
  }
  return 1;
}

void describe(Described& to, MeshFileOptions& o) {
  to.flag("compress", &o.compress,
          "write glb with quantised vertices and compressed by meshoptimizer; viewers need "
          "EXT_meshopt_compression");
  to.choice("texture_format", &o.texture_format,
            std::array{TextureFormat::kPng, TextureFormat::kJpeg},
            "of the images in or beside exported files: png (exact), or jpeg (smaller)");
  to.choice(
      "unit", &o.unit,
      std::array{LengthUnit::kMillimetre, LengthUnit::kCentimetre, LengthUnit::kMetre,
                 LengthUnit::kInch},
      "length of a scene unit: stl is written in millimetres, glb in metres, and usdz says "
      "it (default: stl keeps the scene's numbers, and in glb and usdz they count as metres)");
}

PageImage encode_page(const RgbImage& page, TextureFormat format) {
  if (format == TextureFormat::kJpeg)
    return {io::encode_jpeg(page.width, page.height, page.rgb, kJpegQuality), "image/jpeg"};
  return {io::encode_png(page.width, page.height, 3, page.rgb), "image/png"};
}

const char* extension_of(TextureFormat format) {
  return format == TextureFormat::kPng ? "png" : "jpg";
}

}  // namespace photohull

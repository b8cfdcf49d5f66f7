#include "pipeline/convert.h"

#include <cmath>

#include "core/error.h"
#include "io/image_file.h"
#include "masks/masks.h"
#include "views/undistort.h"

namespace photohull::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxGrowth = 2;  // as prepare_views has it

/// Straight 8-bit sRGB RGBA.
std::vector<std::uint8_t> srgb_bytes(const ColourImage& image) {
  if (image.encoding == ColourImage::Encoding::kSrgb8) return image.bytes;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(std::size_t(image.width) * image.height * 4);
  const auto level = [](double value) {
    return std::uint8_t(std::lround(255 * std::clamp(value, 0.0, 1.0)));
  };
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const glm::vec4 pixel = image.linear(x, y);
      for (int c = 0; c < 3; ++c)
        bytes.push_back(level(srgb_from_linear(std::clamp(double(pixel[c]), 0.0, 1.0))));
      bytes.push_back(level(pixel.a));
    }
  return bytes;
}

void drop_alpha(std::vector<std::uint8_t>& rgba) {
  std::size_t out = 0;
  for (std::size_t i = 0; i < rgba.size(); ++i)
    if (i % 4 != 3) rgba[out++] = rgba[i];
  rgba.resize(out);
}

/// The view's name without folders and extension, told apart by its index where names repeat.
std::string stem_of(const Scene& scene, std::size_t index) {
  const std::string stem = fs::path(scene.views[index].name).stem().string();
  for (std::size_t i = 0; i < scene.views.size(); ++i)
    if (i != index && fs::path(scene.views[i].name).stem() == stem)
      return stem + "_" + std::to_string(index);
  return stem;
}

}  // namespace

Scene undistort_scene(const Scene& scene, const fs::path& folder, Progress& progress) {
  for (const char* part : {"images", "masks"}) {
    std::error_code failure;
    fs::create_directories(folder / part, failure);
    if (failure)
      throw Error(concat((folder / part).string(), ": the folder cannot be made (",
                         failure.message(), "); choose a place that is writable"));
  }
  const ViewLoader loader{[](const fs::path& path) { return io::read_image(path); },
                          [](const fs::path& path) { return io::read_mask(path); }};
  Scene result = scene;
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    progress.check_cancelled();
    progress.update(double(i) / double(scene.views.size()));
    const SourceView& source = scene.views[i];
    PreparedView view{source.name, source.camera, loader.image(source.image), {}};
    bool from_ones = false;  // either way the mask is written with 255
    take_given_mask(source, loader, view, from_ones);
    make_opaque(view.image);
    rectify(source.distortion, kMaxGrowth, view);
    SourceView& target = result.views[i];
    const std::string name = stem_of(scene, i) + ".png";
    std::vector<std::uint8_t> bytes = srgb_bytes(view.image);
    if (!view.image.has_alpha) drop_alpha(bytes);
    target.image = folder / "images" / name;
    io::write_png(target.image, view.image.width, view.image.height, view.image.has_alpha ? 4 : 3,
                  bytes);
    target.mask.clear();
    if (!view.mask.empty()) {
      target.mask = folder / "masks" / name;
      io::write_png(target.mask, view.mask.width, view.mask.height, 1, view.mask.coverage);
    }
    target.name = name;
    target.camera = view.camera;
    target.distortion = {};
  }
  std::error_code ignored;
  fs::remove(folder / "masks", ignored);  // where it is empty
  return result;
}

}  // namespace photohull::pipeline

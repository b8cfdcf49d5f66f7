// What a reconstruction starts from: a scene, and how its photographs are read.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/file_mask.h"
#include "core/image.h"
#include "core/scene.h"
#include "core/view_loader.h"
#include "io/load_scene.h"

namespace photohull::pipeline {

/// Where pixels come from, by SourceView's paths; those of photographs in memory are no files. All
/// throw Error for what cannot be read, and are called from several threads at once.
struct PhotographReader {
  /// Width and height in pixels, without decoding.
  std::function<glm::ivec2(const std::filesystem::path&)> size;
  /// At a scale in (0, 1]: pixels are means, in linear light, of what they cover.
  std::function<ColourImage(const std::filesystem::path&, double scale)> image;
  /// The same for coverage; of scales for x and y.
  std::function<FileMask(const std::filesystem::path&, const glm::dvec2& scale)> mask;
};

/// Files, by OpenImageIO.
PhotographReader file_reader();

struct Photographs {
  Scene scene;  ///< in the photographs' own pixels
  /// How they were chosen and which masks they are to have; goes into the report.
  io::LoadSceneOptions load;
  PhotographReader reader = file_reader();
  std::string digest;  ///< of pixels in memory; empty for files
};

/// The scene of a folder or file, in any format (io::load_scene); pixels are decoded when a
/// reconstruction asks for them. Throws as io::load_scene does.
Photographs load_photographs(const std::filesystem::path& path,
                             const io::LoadSceneOptions& options = {});

/// A photograph that the caller has in memory.
struct MemoryPhotograph {
  std::string name;  ///< unique among them
  Camera camera;     ///< world and pixels as core/camera.h has them; of the image's size
  ColourImage image;
  Mask mask;  ///< of the image's size; empty: none (made from the background where that is plain)
  Distortion distortion{};  ///< of the lens
};

/// A scene of these. `box`: the region of interest in world units; nothing: found in the
/// photographs. Throws Error naming the photograph whose sizes do not match or whose name is not
/// unique or empty.
Photographs photographs_in_memory(std::vector<MemoryPhotograph> photographs,
                                  const std::optional<Box>& box = std::nullopt);

/// Reads the photographs, masks and backgrounds of the views at their scales, one each. `scene` is
/// in its files' pixels. Masks that are of another size than their photographs, as they are where
/// these are scaled copies, come in the size that the photographs are read in.
ViewLoader reduced_loader(const PhotographReader& reader, const Scene& scene,
                          std::span<const double> scales);

}  // namespace photohull::pipeline

#include "pipeline/photographs.h"

#include <map>
#include <memory>

#include "core/error.h"
#include "io/image_file.h"
#include "io/reduce_image.h"
#include "pipeline/input_hashes.h"

namespace photohull::pipeline {
namespace fs = std::filesystem;
namespace {

constexpr const char* kMaskOf = "mask of ";

struct InMemory {
  std::map<fs::path, ColourImage> images;
  std::map<fs::path, Mask> masks;
};

PhotographReader memory_reader(std::shared_ptr<const InMemory> memory) {
  return {[memory](const fs::path& path) {
            if (const auto mask = memory->masks.find(path); mask != memory->masks.end())
              return glm::ivec2(mask->second.width, mask->second.height);
            const ColourImage& image = memory->images.at(path);
            return glm::ivec2(image.width, image.height);
          },
          [memory](const fs::path& path, double scale) {
            return io::reduced(memory->images.at(path), scale);
          },
          [memory](const fs::path& path, const glm::dvec2& scale) {
            return FileMask(io::reduced(memory->masks.at(path), scale));
          }};
}

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw Error(concat("photograph '", name, "': ", why));
}

void check_sizes(const MemoryPhotograph& p) {
  const Intrinsics& k = p.camera.intrinsics;
  const ColourImage& image = p.image;
  if (image.width <= 0 || image.height <= 0 || k.width != image.width || k.height != image.height)
    refuse(p.name, concat("the picture has ", image.width, "x", image.height,
                          " pixels but its camera is for ", k.width, "x", k.height));
  const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height);
  if (image.bytes.size() != pixels * image.bytes_per_pixel())
    refuse(p.name, concat("the picture needs ", pixels * image.bytes_per_pixel(), " bytes and has ",
                          image.bytes.size()));
  if (p.mask.empty()) return;
  if (p.mask.width != image.width || p.mask.height != image.height ||
      p.mask.coverage.size() != pixels)
    refuse(p.name,
           concat("the mask has ", p.mask.width, "x", p.mask.height, " pixels and ",
                  p.mask.coverage.size(), " values, the picture ", image.width, "x", image.height));
}

}  // namespace

PhotographReader file_reader() {
  return {[](const fs::path& path) {
            const io::ImageSize size = io::read_image_size(path);
            return glm::ivec2(size.width, size.height);
          },
          [](const fs::path& path, double scale) { return io::read_image(path, scale); },
          [](const fs::path& path, const glm::dvec2& scale) { return io::read_mask(path, scale); }};
}

Photographs load_photographs(const fs::path& path, const io::LoadSceneOptions& options) {
  return {io::load_scene(path, options), options};
}

Photographs photographs_in_memory(std::vector<MemoryPhotograph> photographs,
                                  const std::optional<Box>& box) {
  Photographs out;
  out.scene.path = out.scene.file = "photographs in memory";
  out.scene.box = box;
  if (box) out.scene.box_source = "the caller";
  auto memory = std::make_shared<InMemory>();
  for (MemoryPhotograph& p : photographs) {
    if (p.name.empty()) throw Error("a photograph has no name");
    check_sizes(p);
    SourceView view;
    view.name = p.name;
    view.image = p.name;
    view.camera = p.camera;
    view.distortion = p.distortion;
    out.digest += digest_of(p.image.bytes) + digest_of(p.mask.coverage);
    if (!p.mask.empty()) {
      view.mask = kMaskOf + p.name;
      memory->masks.emplace(view.mask, std::move(p.mask));
    }
    if (!memory->images.emplace(view.image, std::move(p.image)).second)
      refuse(p.name, "another one has the same name");
    out.scene.listed.push_back(view.name);
    out.scene.views.push_back(std::move(view));
  }
  out.reader = memory_reader(std::move(memory));
  return out;
}

ViewLoader reduced_loader(const PhotographReader& reader, const Scene& scene,
                          std::span<const double> scales) {
  PHOTOHULL_CHECK_OP(scales.size(), ==, scene.views.size());
  struct Reading {
    double scale;
    glm::dvec2 size;  // pixels of the photograph as it is
  };
  std::map<fs::path, Reading> readings;
  for (std::size_t i = 0; i < scales.size(); ++i) {
    const SourceView& view = scene.views[i];
    const Intrinsics& k = view.camera.intrinsics;
    for (const fs::path* path : {&view.image, &view.mask, &view.plate})
      readings[*path] = {scales[i], {k.width, k.height}};
  }
  return {[reader, readings](const fs::path& path) {
            return reader.image(path, readings.at(path).scale);
          },
          [reader, readings](const fs::path& path) {
            const Reading& reading = readings.at(path);
            if (reading.scale == 1) return reader.mask(path, glm::dvec2(1));
            return reader.mask(path,
                               reading.scale * (reading.size / glm::dvec2(reader.size(path))));
          }};
}

}  // namespace photohull::pipeline

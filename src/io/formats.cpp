#include "io/formats.h"

#include <algorithm>

#include "core/error.h"
#include "io/find_files.h"
#include "io/scene_readers.h"
#include "io/text_file.h"
#include "io/write_scene.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

fs::path find_middlebury(const fs::path& folder) { return only_file_ending(folder, "_par.txt"); }

bool is_middlebury(const fs::path& file) { return file.filename().string().ends_with("_par.txt"); }

/// The folder of a COLMAP model in or below a folder; empty when there is none.
fs::path model_folder(const fs::path& folder, const char* extension) {
  for (const fs::path& candidate : {folder, folder / "sparse" / "0", folder / "sparse"})
    if (is_file(candidate / (std::string("cameras") + extension)) &&
        is_file(candidate / (std::string("images") + extension)))
      return candidate;
  return {};
}

fs::path find_colmap_text(const fs::path& folder) { return model_folder(folder, ".txt"); }
fs::path find_colmap_binary(const fs::path& folder) { return model_folder(folder, ".bin"); }

bool is_model_file(const fs::path& file, const char* extension) {
  const fs::path stem = file.stem();
  return file.extension() == extension &&
         (stem == "cameras" || stem == "images" || stem == "points3D");
}

bool is_colmap_text(const fs::path& file) { return is_model_file(file, ".txt"); }
bool is_colmap_binary(const fs::path& file) { return is_model_file(file, ".bin"); }

fs::path find_transforms(const fs::path& folder) {
  const fs::path file = folder / "transforms.json";
  return is_file(file) ? file : fs::path();
}

bool is_transforms(const fs::path& file) {
  return file.extension() == ".json" && !is_openmvg(file) && !is_opencv(file);
}

using F = SceneFormat;

const FormatEntry kEntries[] = {
    {F::kMiddlebury, "*_par.txt", find_middlebury, is_middlebury, false, read_middlebury,
     write_middlebury},
    {F::kColmapBinary, "cameras.bin and images.bin (also in sparse/0, sparse)", find_colmap_binary,
     is_colmap_binary, true, read_colmap_binary, write_colmap_binary},
    {F::kColmapText, "cameras.txt and images.txt (also in sparse/0, sparse)", find_colmap_text,
     is_colmap_text, true, read_colmap_text, write_colmap_text},
    {F::kTransforms, "transforms.json", find_transforms, is_transforms, false, read_transforms,
     write_transforms},
    {F::kAliceVision, "*.sfm", find_alicevision, is_alicevision, false, read_alicevision,
     write_alicevision},
    {F::kOpenMvg, "sfm_data.json", find_openmvg, is_openmvg, false, read_openmvg, write_openmvg},
    {F::kMetashape, "*.xml of Metashape", find_metashape, is_metashape, false, read_metashape,
     write_metashape},
    {F::kRealityCapture, "*.csv of RealityCapture", find_realitycapture, is_realitycapture, false,
     [](const fs::path& file) { return read_realitycapture(file, {}); }, write_realitycapture,
     read_realitycapture},
    {F::kNvm, "*.nvm", find_nvm, is_nvm, false, read_nvm, write_nvm},
    {F::kPmvs, "txt/00000000.txt", find_pmvs, is_pmvs, true, read_pmvs, write_pmvs},
    {F::kBundler, "bundle.out", find_bundler, is_bundler, false, read_bundler, write_bundler},
    {F::kMve, "views/*.mve/meta.ini", find_mve, is_mve, true, read_mve, write_mve},
    {F::kMvsNet, "cams/*_cam.txt", find_mvsnet, is_mvsnet, true, read_mvsnet, write_mvsnet},
    {F::kStrecha, "*.camera", find_strecha, is_strecha, true, read_strecha, write_strecha},
    {F::kProjection, "projections.txt or *.P", find_projection, is_projection, false,
     read_projection, write_projection},
    {F::kMatlab, "*.mat", find_matlab, is_matlab, false,
     [](const fs::path& file) { return read_matlab(file, {}); }, write_matlab, read_matlab},
    {F::kOpenCv, "cameras.yml or intri.yml", find_opencv, is_opencv, false, read_opencv,
     write_opencv}};

}  // namespace

std::span<const FormatEntry> format_entries() { return kEntries; }

const FormatEntry& format_entry(SceneFormat format) {
  const auto found = std::find_if(std::begin(kEntries), std::end(kEntries),
                                  [&](const FormatEntry& e) { return e.format == format; });
  PHOTOHULL_CHECK(found != std::end(kEntries));
  return *found;
}

std::vector<SceneFormat> scene_formats() {
  std::vector<SceneFormat> formats;
  for (const FormatEntry& entry : kEntries) formats.push_back(entry.format);
  return formats;
}

void write_scene(const Scene& scene, SceneFormat format, const fs::path& folder) {
  format_entry(format).write(scene, folder);
}

RawScene read_raw_scene(SceneFormat format, const fs::path& file, const fs::path& images) {
  const FormatEntry& entry = format_entry(format);
  if (images.empty()) return entry.read(file);
  RawScene raw = entry.read_with ? entry.read_with(file, images) : entry.read(file);
  raw.image_folders = {images};
  return raw;
}

}  // namespace photohull::io

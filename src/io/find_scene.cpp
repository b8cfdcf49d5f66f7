#include "io/find_scene.h"

#include <algorithm>

#include "core/error.h"
#include "io/text_file.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

constexpr SceneFormat kOrder[] = {SceneFormat::kMiddlebury, SceneFormat::kColmapBinary,
                                  SceneFormat::kColmapText, SceneFormat::kTransforms};

const char* looked_for(SceneFormat format) {
  switch (format) {
    case SceneFormat::kMiddlebury:
      return "*_par.txt";
    case SceneFormat::kColmapText:
      return "cameras.txt and images.txt (also in sparse/0, sparse)";
    case SceneFormat::kColmapBinary:
      return "cameras.bin and images.bin (also in sparse/0, sparse)";
    case SceneFormat::kTransforms:
      return "transforms.json";
  }
  return "";
}

std::vector<fs::path> par_files(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder, failure))
    if (entry.path().filename().string().ends_with("_par.txt")) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

/// The folder of a COLMAP model in or below a folder; empty when there is none.
fs::path model_folder(const fs::path& folder, const char* extension) {
  for (const fs::path& candidate : {folder, folder / "sparse" / "0", folder / "sparse"})
    if (is_file(candidate / (std::string("cameras") + extension)) &&
        is_file(candidate / (std::string("images") + extension)))
      return candidate;
  return {};
}

fs::path find_in_folder(const fs::path& folder, SceneFormat format) {
  switch (format) {
    case SceneFormat::kMiddlebury: {
      const std::vector<fs::path> files = par_files(folder);
      if (files.size() > 1)
        throw Error(concat(folder.string(), ": several scenes lie here (",
                           files[0].filename().string(), ", ", files[1].filename().string(),
                           "); give the path of one of them"));
      return files.empty() ? fs::path() : files[0];
    }
    case SceneFormat::kColmapText:
      return model_folder(folder, ".txt");
    case SceneFormat::kColmapBinary:
      return model_folder(folder, ".bin");
    case SceneFormat::kTransforms: {
      const fs::path file = folder / "transforms.json";
      return is_file(file) ? file : fs::path();
    }
  }
  return {};
}

bool is_colmap(SceneFormat format) {
  return format == SceneFormat::kColmapText || format == SceneFormat::kColmapBinary;
}

SceneLocation search_folder(const fs::path& folder, std::optional<SceneFormat> wanted) {
  std::optional<SceneLocation> found;
  std::string tried;
  for (const SceneFormat format : kOrder) {
    if (wanted && *wanted != format) continue;
    tried += (tried.empty() ? "" : "; ") + std::string(looked_for(format));
    const fs::path file = find_in_folder(folder, format);
    if (file.empty()) continue;
    if (!found)
      found = SceneLocation{format, file, {}};
    else if (!is_colmap(found->format) || !is_colmap(format))  // one model saved twice is usual
      found->warnings.push_back(concat(folder.string(), " also holds a ", to_string(format),
                                       " scene, passed over for the ", to_string(found->format),
                                       " one; use --format to choose"));
  }
  if (!found)
    throw Error(concat(folder.string(), ": no scene found here (looked for ", tried,
                       "); give the folder or file that lists the cameras"));
  std::error_code ignored;
  const fs::path sibling = found->file.parent_path() / "1";
  if (is_colmap(found->format) && found->file.filename() == "0" && fs::exists(sibling, ignored))
    found->warnings.push_back(concat(sibling.string(),
                                     " is a separate COLMAP model of other "
                                     "images and was not read"));
  return *found;
}

/// A file's format from its name alone.
std::optional<SceneFormat> format_of_file(const fs::path& file) {
  const std::string name = file.filename().string();
  for (const char* part : {"cameras", "images", "points3D"}) {
    if (name == std::string(part) + ".txt") return SceneFormat::kColmapText;
    if (name == std::string(part) + ".bin") return SceneFormat::kColmapBinary;
  }
  if (name.ends_with("_par.txt")) return SceneFormat::kMiddlebury;
  if (name.ends_with(".json")) return SceneFormat::kTransforms;
  return std::nullopt;
}

}  // namespace

SceneLocation find_scene(const fs::path& path, std::optional<SceneFormat> format) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) return search_folder(path, format);
  if (!is_file(path))
    throw Error(concat(path.string(),
                       ": there is no such file or folder; give a scene folder or "
                       "the file that lists the cameras"));
  if (!format) format = format_of_file(path);
  if (!format)
    throw Error(concat(path.string(),
                       ": the name is not one of *_par.txt, transforms.json or a "
                       "COLMAP cameras, images or points3D file; use --format"));
  // A bare file name has an empty parent, which is no folder that can be opened.
  const fs::path parent = path.has_parent_path() ? path.parent_path() : fs::path(".");
  return {*format, is_colmap(*format) ? parent : parent / path.filename(), {}};
}

}  // namespace photohull::io

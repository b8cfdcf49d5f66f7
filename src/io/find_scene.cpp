#include "io/find_scene.h"

#include "core/error.h"
#include "core/option_word.h"
#include "io/formats.h"
#include "io/scene_readers.h"
#include "io/text_file.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

bool is_colmap(SceneFormat format) {
  return format == SceneFormat::kColmapText || format == SceneFormat::kColmapBinary;
}

SceneLocation search_folder(const fs::path& folder, std::optional<SceneFormat> wanted) {
  std::optional<SceneLocation> found;
  std::string tried;
  for (const FormatEntry& entry : format_entries()) {
    const SceneFormat format = entry.format;
    if (wanted && *wanted != format) continue;
    tried += (tried.empty() ? "" : "; ") + std::string(entry.looked_for);
    const fs::path file = entry.find(folder);
    if (file.empty()) continue;
    if (!found)
      found = SceneLocation{format, file, {}};
    else if (!is_colmap(found->format) || !is_colmap(format))  // one model saved twice is usual
      found->warnings.push_back(concat(folder.string(), " also holds a ", to_string(format),
                                       " scene, passed over for the ", to_string(found->format),
                                       " one; use ", option_word("format"), " to choose"));
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

/// Throws Error where the folder's files cannot be listed or reached.
void check_open(const fs::path& folder) {
  std::error_code failure;
  const fs::directory_iterator listed(folder, failure);
  if (failure || !fs::exists(folder / ".", failure))
    throw Error(concat(folder.string(), ": the folder cannot be entered (", failure.message(),
                       "); check its permissions"));
}

std::optional<SceneFormat> format_of_file(const fs::path& file) {
  for (const FormatEntry& entry : format_entries())
    if (entry.recognises(file)) return entry.format;
  return std::nullopt;
}

}  // namespace

SceneLocation find_scene(const fs::path& path, std::optional<SceneFormat> format) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    check_open(path);
    return search_folder(path, format);
  }
  if (!is_file(path))
    throw Error(concat(path.string(),
                       ": there is no such file or folder; give a scene folder or "
                       "the file that lists the cameras"));
  if (!format && is_calibration(path))
    throw Error(concat(path.string(),
                       ": is a calibration, which lists no photographs of an object; make a scene "
                       "with photohull convert ",
                       path.string(), " ", option_word("images", "FOLDER"), " ",
                       option_word("to", "FORMAT"), " ", option_word("out", "DIR")));
  if (!format) format = format_of_file(path);
  if (!format)
    throw Error(concat(path.string(),
                       ": this is no scene's file by its name and beginning; give the folder that "
                       "it belongs to, or ",
                       option_word("format")));
  // A bare file name has an empty parent, which is no folder that can be opened.
  const fs::path parent = path.has_parent_path() ? path.parent_path() : fs::path(".");
  return {*format, format_entry(*format).reads_folder ? parent : parent / path.filename(), {}};
}

}  // namespace photohull::io

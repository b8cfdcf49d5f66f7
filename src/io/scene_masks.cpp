#include "io/scene_masks.h"

#include <algorithm>

#include "core/error.h"
#include "core/option_word.h"
#include "io/find_files.h"
#include "io/image_file.h"
#include "io/text_file.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kNamed = 3;  // views, in a sentence

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

constexpr const char* kMaskEndings[] = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".exr"};

/// NAME_mask.png for NAME.jpg, or with another extension; empty when there is none.
fs::path find_suffixed(const fs::path& image) {
  for (const char* extension : kMaskEndings) {
    const fs::path candidate = image.parent_path() / (image.stem().string() + "_mask" + extension);
    if (is_file(candidate)) return candidate;
  }
  return {};
}

/// masks/ in the scene's folder, beside the image, or beside the images/ folder that holds it,
/// if need be through subfolders such as images/left/.
fs::path masks_folder(const fs::path& scene_folder, const fs::path& image) {
  const fs::path beside = image.parent_path();
  std::vector<fs::path> candidates = {scene_folder / "masks", beside / "masks"};
  fs::path folder = beside;
  for (int level = 0; level < 3; ++level, folder = folder.parent_path())
    if (folder.filename().string().starts_with("images"))
      candidates.push_back(folder.parent_path() / "masks");
  const auto found = std::find_if(candidates.begin(), candidates.end(), is_folder);
  return found == candidates.end() ? fs::path() : *found;
}

/// A mask may also have the size that its image's camera is for, where the image is a copy of
/// another size: it is scaled when it is read.
void check_mask_size(const RawView& raw, const SourceView& view) {
  const ImageSize size = read_image_size(view.mask);
  const Intrinsics &k = view.camera.intrinsics, &stated = raw.camera.intrinsics;
  if (size.width == stated.width && size.height == stated.height) return;
  if (size.width != k.width || size.height != k.height)
    throw Error(concat(view.mask.string(), ": the mask is ", size.width, " x ", size.height,
                       " but its image ", view.image.string(), " is ", k.width, " x ", k.height,
                       "; use a mask of the image's size or ", option_word("masks", "none")));
}

/// Views that a folder holds no mask for.
struct Unmasked {
  fs::path folder;  ///< that was searched last
  std::vector<std::string> names;
};

/// "DIR holds no mask for 4 of 16 views (a.png, b.png, c.png and 1 more)"
std::string counted(const Unmasked& without, std::size_t all) {
  std::string names;
  for (std::size_t i = 0; i < std::min(without.names.size(), kNamed); ++i)
    names += (i ? ", " : "") + without.names[i];
  if (without.names.size() > kNamed)
    names += concat(" and ", without.names.size() - kNamed, " more");
  return concat(without.folder.string(), " holds no mask for ", without.names.size(), " of ", all,
                " views (", names, ")");
}

/// "NAME.EXT.png and NAME.png, .jpg, .tif, .exr" for a view.
std::string looked_for(const std::string& name) {
  const std::string stem = fs::path(name).stem().string();
  return concat(name, ".png and ", stem, ".png, .jpg, .tif, .exr, or ", stem, "_mask.png");
}

/// Throws Error where `strict` asks for the masks of all views; else warns.
void note_unmasked(const Unmasked& without, bool strict, Scene& scene) {
  if (without.names.empty()) return;
  const std::string said = counted(without, scene.views.size());
  if (strict)
    throw Error(concat(said, "; ", option_word("strict"), " asks for all of them: add them (for ",
                       without.names.front(), ", ", looked_for(without.names.front()),
                       " were looked for) or leave these views out with ", option_word("views")));
  scene.warnings.push_back(
      concat(said, ": these are used without (or with what their alpha or background tells); ",
             option_word("strict"), " refuses"));
}

void attach_from_directory(const LoadSceneOptions& options, const std::vector<RawView>& raw,
                           Scene& scene) {
  const fs::path& folder = options.mask_directory;
  if (!is_folder(folder)) throw Error(concat(folder.string(), ": there is no such mask folder"));
  Unmasked without{folder, {}};
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    SourceView& view = scene.views[i];
    view.mask = find_mask(folder, view.image, raw[i].listed);
    if (view.mask.empty()) without.names.push_back(view.name);
  }
  if (without.names.size() == scene.views.size())
    throw Error(concat(folder.string(), ": there is no mask for any of the ", scene.views.size(),
                       " views (for the first, ", without.names.front(), ", looked for ",
                       looked_for(without.names.front()),
                       "); name the masks as the photographs or give another folder"));
  note_unmasked(without, options.strict, scene);
}

void attach_stated(const fs::path& scene_folder, const RawView& raw, SourceView& view) {
  view.mask = scene_folder / raw.mask;
  view.mask_made = raw.mask_made;
  for (const std::string& path : shorter_paths(raw.mask))  // the name alone may be the photograph's
    if (!is_file(view.mask) && path.find('/') != std::string::npos && is_file(scene_folder / path))
      view.mask = scene_folder / path;
  if (!is_file(view.mask))
    throw Error(concat(raw.where, ": mask_path names ", view.mask.string(),
                       ", but there is no such file; add it or use ",
                       option_word("masks", "none")));
}

void attach_automatically(const LoadSceneOptions& options, const fs::path& scene_folder,
                          const std::vector<RawView>& raw, Scene& scene) {
  Unmasked without;
  bool any = false;  // does any folder hold masks?
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    SourceView& view = scene.views[i];
    if (!raw[i].mask.empty()) {
      attach_stated(scene_folder, raw[i], view);
      continue;
    }
    const fs::path folder = masks_folder(scene_folder, view.image);
    view.mask =
        folder.empty() ? find_suffixed(view.image) : find_mask(folder, view.image, raw[i].listed);
    any = any || !folder.empty() || !view.mask.empty();
    if (!view.mask.empty()) continue;
    without.folder = folder.empty() ? folder_of(view.image) : folder;
    without.names.push_back(view.name);
  }
  if (!any) return;
  note_unmasked(without, options.strict, scene);
}

}  // namespace

fs::path name_within(const std::string& listed) {
  fs::path name;
  for (const fs::path& part : fs::path(listed).lexically_normal().relative_path())
    if (part != "..") name /= part;
  return name;
}

fs::path find_mask(const fs::path& folder, const fs::path& image, const std::string& listed) {
  for (const fs::path& name : {name_within(listed), image.filename()}) {
    fs::path whole = folder / name;
    whole += ".png";
    if (is_file(whole)) return whole;
    for (const char* extension : kMaskEndings) {
      const fs::path candidate = fs::path(folder / name).replace_extension(extension);
      // A list of "images/0001.png" must not make the image its own mask.
      std::error_code ignored;
      if (is_file(candidate) && !fs::equivalent(candidate, image, ignored)) return candidate;
    }
    const fs::path suffixed = find_suffixed(folder / name);
    if (!suffixed.empty()) return suffixed;
  }
  return {};
}

void attach_masks(const LoadSceneOptions& options, const fs::path& scene_folder,
                  const std::vector<RawView>& raw, Scene& scene) {
  if (!options.background.empty()) return;
  switch (options.masks) {
    case MaskSource::kNone:
    case MaskSource::kBackground:
      return;
    case MaskSource::kDirectory:
      attach_from_directory(options, raw, scene);
      break;
    case MaskSource::kAuto:
      attach_automatically(options, scene_folder, raw, scene);
      break;
  }
  for (std::size_t i = 0; i < scene.views.size(); ++i)
    if (!scene.views[i].mask.empty()) check_mask_size(raw[i], scene.views[i]);
}

void attach_plates(const LoadSceneOptions& options, const std::vector<RawView>& raw, Scene& scene) {
  const fs::path& given = options.background;
  if (given.empty()) return;
  const bool folder = is_folder(given);
  if (!folder && !is_file(given))
    throw Error(
        concat(given.string(), ": there is no such background; ", option_word("background"),
               " takes a photograph without the object, or a folder with one for every view"));
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    SourceView& view = scene.views[i];
    view.plate = folder ? find_mask(given, view.image, raw[i].listed) : given;
    if (view.plate.empty())
      throw Error(concat(given.string(), ": there is no background for ", view.name,
                         " (looked for ", looked_for(view.name),
                         "); add it or leave the view out with ", option_word("views")));
    const ImageSize size = read_image_size(view.plate);
    const Intrinsics& k = view.camera.intrinsics;
    if (size.width != k.width || size.height != k.height)
      throw Error(concat(view.plate.string(), ": the background is ", size.width, " x ",
                         size.height, " but ", view.image.string(), " is ", k.width, " x ",
                         k.height, "; it must be taken with the same camera and settings"));
  }
}

}  // namespace photohull::io

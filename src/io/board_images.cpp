#include "io/board_images.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <set>

#include "core/error.h"
#include "core/option_word.h"
#include "io/find_files.h"
#include "io/natural_less.h"
#include "io/text_file.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

constexpr const char *kCamera = "{camera}", *kMoment = "{moment}";
constexpr int kDeepest = 3;

struct Natural {
  bool operator()(const std::string& a, const std::string& b) const { return natural_less(a, b); }
};

/// prefix FIRST middle SECOND suffix.
struct Pattern {
  std::string prefix, middle, suffix;
  bool camera_first = true;

  explicit Pattern(const std::string& text) {
    const std::size_t camera = text.find(kCamera), moment = text.find(kMoment);
    const std::string wanted =
        concat(option_word("rig", text), ": expected a pattern with ", kCamera, " and ", kMoment,
               " once each and something between them, such as ", kCamera, "/", kMoment);
    if (camera == std::string::npos || moment == std::string::npos ||
        text.rfind(kCamera) != camera || text.rfind(kMoment) != moment)
      throw UsageError(wanted);
    camera_first = camera < moment;
    constexpr std::size_t kLength = 8;  // of either
    const std::size_t first = std::min(camera, moment), second = std::max(camera, moment);
    prefix = text.substr(0, first);
    middle = text.substr(first + kLength, second - first - kLength);
    suffix = text.substr(second + kLength);
    if (middle.empty()) throw UsageError(wanted);
  }

  /// Camera and moment.
  std::optional<std::pair<std::string, std::string>> match(const std::string& path) const {
    if (path.size() < prefix.size() + suffix.size() || !path.starts_with(prefix) ||
        !path.ends_with(suffix))
      return std::nullopt;
    const std::string inner =
        path.substr(prefix.size(), path.size() - prefix.size() - suffix.size());
    const std::size_t cut = inner.find(middle);
    if (cut == std::string::npos || cut == 0 || cut + middle.size() == inner.size())
      return std::nullopt;
    std::string first = inner.substr(0, cut), second = inner.substr(cut + middle.size());
    if (!camera_first) std::swap(first, second);
    return std::pair(first, second);
  }
};

void list_below(const fs::path& folder, int depth, std::vector<fs::path>& found) {
  for (const fs::path& image : images_in(folder)) found.push_back(image);
  if (depth == 0) return;
  std::error_code failure;
  std::vector<fs::path> folders;
  for (fs::directory_iterator i(folder, failure), end; !failure && i != end; i.increment(failure))
    if (i->is_directory(failure)) folders.push_back(i->path());
  if (failure) throw Error(concat(folder.string(), ": cannot be listed (", failure.message(), ")"));
  std::sort(folders.begin(), folders.end());
  for (const fs::path& inner : folders) list_below(inner, depth - 1, found);
}

bool is_hidden(const fs::path& file) { return file.filename().string().starts_with('.'); }

constexpr const char* kUnreadable[] = {".heic", ".heif", ".dng", ".cr2", ".cr3",
                                       ".nef",  ".arw",  ".raf", ".orf", ".rw2"};

}  // namespace

std::vector<fs::path> list_unreadable(const std::vector<std::string>& given) {
  std::vector<fs::path> found;
  std::error_code failure;
  for (const std::string& path : given)
    for (fs::directory_iterator i(path, failure), end; !failure && i != end; i.increment(failure)) {
      std::string extension = i->path().extension().string();
      std::ranges::transform(extension, extension.begin(),
                             [](unsigned char c) { return char(std::tolower(c)); });
      if (!is_hidden(i->path()) &&
          std::ranges::find(kUnreadable, extension) != std::end(kUnreadable))
        found.push_back(i->path());
    }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<fs::path> list_images(const std::vector<std::string>& given) {
  std::vector<fs::path> images;
  for (const std::string& path : given) {
    std::error_code failure;
    if (!fs::is_directory(path, failure)) {
      if (!is_file(path)) throw Error(concat(path, ": there is no such file or folder"));
      images.emplace_back(path);
      continue;
    }
    for (const fs::path& image : images_in(path))
      if (!is_hidden(image)) images.push_back(image);
  }
  if (images.empty())
    throw Error("no picture was found; give images or the folder that holds them");
  return images;
}

RigImages list_rig_images(const fs::path& folder, const std::string& pattern) {
  const Pattern names(pattern);
  std::error_code failure;
  if (!fs::is_directory(folder, failure))
    throw Error(concat(folder.string(),
                       ": is no folder; a rig's pictures are found by their names below one"));
  std::vector<fs::path> found;
  list_below(folder, kDeepest, found);
  std::map<std::string, std::map<std::string, fs::path, Natural>, Natural> cameras;
  std::set<std::string, Natural> moments;
  for (const fs::path& image : found) {
    const fs::path relative = image.lexically_relative(folder);
    const auto match = names.match((relative.parent_path() / relative.stem()).generic_string());
    if (!match) continue;
    const auto [earlier, fresh] = cameras[match->first].emplace(match->second, image);
    if (!fresh)
      throw Error(concat(image.string(), ": camera ", match->first, " has another picture of ",
                         match->second, ", ", earlier->second.string(), "; remove one"));
    moments.insert(match->second);
  }
  if (cameras.empty())
    throw Error(concat(folder.string(), ": none of ", found.size(), " pictures is called as ",
                       option_word("rig", pattern), " says"));
  RigImages rig;
  rig.moments.assign(moments.begin(), moments.end());
  for (const auto& [camera, images] : cameras) {
    rig.cameras.push_back(camera);
    rig.images.emplace_back();
    for (const std::string& moment : rig.moments) {
      const auto image = images.find(moment);
      rig.images.back().push_back(image == images.end() ? fs::path() : image->second);
    }
  }
  return rig;
}

}  // namespace photohull::io

#include "io/find_files.h"

#include <algorithm>
#include <cctype>
#include <fstream>

#include "core/error.h"
#include "io/natural_less.h"
#include "io/text_file.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

constexpr const char* kImageEndings[] = {".png", ".jpg", ".jpeg", ".tif",  ".tiff", ".exr",
                                         ".ppm", ".pgm", ".bmp",  ".webp", ".avif"};

/// The file that a path means, tidied where that does not change it (".." after a symbolic link
/// may); empty when there is none.
fs::path existing(const fs::path& path) {
  const fs::path tidy = path.lexically_normal();
  return is_file(tidy) ? tidy : is_file(path) ? path : fs::path();
}

std::string lower(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

void sort_naturally(std::vector<fs::path>& paths) {
  std::sort(paths.begin(), paths.end(), [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
}

}  // namespace

std::vector<fs::path> files_ending(const fs::path& folder, std::string_view ending) {
  std::vector<fs::path> found;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder, failure))
    if (entry.path().filename().string().ends_with(ending) && is_file(entry.path()))
      found.push_back(entry.path());
  sort_naturally(found);
  return found;
}

fs::path only_file_ending(const fs::path& folder, std::string_view ending) {
  const std::vector<fs::path> files = files_ending(folder, ending);
  if (files.size() > 1)
    throw Error(concat(folder.string(), ": several scenes lie here (", files[0].filename().string(),
                       ", ", files[1].filename().string(), "); give the path of one of them"));
  return files.empty() ? fs::path() : files[0];
}

std::vector<fs::path> images_in(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder, failure)) {
    const std::string extension = lower(entry.path().extension().string());
    if (std::find(std::begin(kImageEndings), std::end(kImageEndings), extension) !=
            std::end(kImageEndings) &&
        is_file(entry.path()))
      found.push_back(entry.path());
  }
  sort_naturally(found);
  return found;
}

fs::path find_listed_image(const std::string& listed, const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders)
    for (const char* extension :
         {"", ".png", ".jpg", ".jpeg", ".PNG", ".JPG", ".tif", ".tiff", ".exr", ".webp", ".avif"}) {
      const fs::path found = existing(folder / (listed + extension));
      if (!found.empty()) return found;
    }
  return {};
}

std::vector<std::string> shorter_paths(const std::string& listed) {
  std::string path = listed;
  std::replace(path.begin(), path.end(), '\\', '/');
  std::vector<std::string> shorter = {path};
  for (std::size_t slash = path.find('/'); slash != std::string::npos;
       slash = path.find('/', slash + 1))
    shorter.push_back(path.substr(slash + 1));
  return shorter;
}

fs::path find_image(const std::string& listed, const std::vector<fs::path>& folders) {
  fs::path found = find_listed_image(listed, folders);
  for (const std::string& path : shorter_paths(listed))
    if (found.empty() && !path.empty()) found = find_listed_image(path, folders);
  return found;
}

std::string file_head(const fs::path& file, std::size_t bytes) {
  std::string head(bytes, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(head.data(), std::streamsize(bytes));
  head.resize(std::size_t(std::max<std::streamsize>(in.gcount(), 0)));
  return head;
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

}  // namespace photohull::io

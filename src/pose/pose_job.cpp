#include "pose/pose_job.h"

#include <set>
#include <system_error>

#include "core/error.h"
#include "core/option_word.h"
#include "io/board_images.h"

namespace photohull::pose {

namespace fs = std::filesystem;

std::vector<std::string> names_of(const std::vector<fs::path>& images) {
  std::multiset<std::string> files;
  for (const fs::path& image : images) files.insert(image.filename().string());
  std::vector<std::string> names;
  for (const fs::path& image : images) {
    const std::string file = image.filename().string();
    names.push_back(files.count(file) == 1 ? file : image.string());
  }
  return names;
}

std::vector<PassOfPhotos> passes_of(const std::vector<std::string>& folders) {
  std::multiset<std::string> all;
  const auto own_name = [](const std::string& folder) {
    fs::path path = fs::absolute(folder).lexically_normal();
    if (path.filename().empty()) path = path.parent_path();
    return path.filename().string();
  };
  for (const std::string& folder : folders) all.insert(own_name(folder));
  std::vector<PassOfPhotos> passes;
  for (const std::string& folder : folders) {
    const std::string name = own_name(folder);
    passes.push_back({all.count(name) == 1 ? name : concat(name, "_", passes.size() + 1),
                      io::list_images({folder})});
  }
  return passes;
}

std::string unused_focal(const PoseJob& job, bool taken) {
  if (!job.focal.given() || taken) return "";
  return concat(option_word("focal"),
                " is not used: the photographs state their focal lengths, or cannot be read");
}

void make_scene_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure)
    throw Error(concat(folder.string(), ": the folder cannot be made (", failure.message(),
                       "); choose another with ", option_word("out")));
}

}  // namespace photohull::pose

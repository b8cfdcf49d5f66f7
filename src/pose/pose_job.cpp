#include "pose/pose_job.h"

#include <set>
#include <system_error>

#include "core/error.h"
#include "core/option_word.h"

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

#include "film_pictures.h"

#include <cstdio>
#include <string>

#include "core/error.h"
#include "io/image_file.h"
#include "photo/fine_detail.h"
#include "photo/for_photographs.h"
#include "photo/grey_image.h"
#include "scene_arguments.h"
#include "terminal_progress.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFrame = "frame_";

/// Pictures while they are looked through; gone afterwards, whatever happens.
class Workspace {
 public:
  explicit Workspace(fs::path folder) : folder_(std::move(folder)) { clear(); }
  ~Workspace() { clear(); }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;
  const fs::path& folder() const { return folder_; }

 private:
  void clear() const {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  fs::path folder_;
};

/// The folder without the pictures of an earlier film.
void clear(const fs::path& folder) {
  make_folder(folder, "--out");
  std::error_code failure;
  std::vector<fs::path> old;
  for (fs::directory_iterator i(folder, failure), end; !failure && i != end; i.increment(failure)) {
    const std::string name = i->path().filename().string();
    if (!name.starts_with(kFrame) && name != ".pictures")
      throw Error(concat(i->path().string(),
                         ": this program did not make it; move it away, or give another folder "
                         "with --out"));
    old.push_back(i->path());
  }
  for (const fs::path& file : old) fs::remove_all(file, failure);
}

fs::path sharpest(const std::vector<fs::path>& pictures) {
  fs::path best;
  double most = -1;
  for (const fs::path& picture : pictures) {
    const double detail = fine_detail(grey_image(io::read_image(picture)));
    if (detail > most) most = detail, best = picture;
  }
  return best;
}

}  // namespace

std::vector<fs::path> take_pictures(const fs::path& film, const fs::path& folder,
                                    const io::FrameOptions& options) {
  TerminalProgress progress(1);
  progress.stage("film", 0.5);
  clear(folder);
  const Workspace work(folder / ".pictures");
  const auto stretches = io::extract_stretches(film, work.folder(), options, progress);
  progress.stage("frames", 0.5);
  std::vector<fs::path> best(stretches.size()), frames;
  const double pixels = stretches.empty() ? 0 : io::pixels_of_largest(stretches.front());
  const auto look_at = [&](std::size_t i) {
    progress.check_cancelled();
    best[i] = sharpest(stretches[i]);
  };
  for_photographs(stretches.size(), pixels, look_at, [&](std::size_t done) {
    progress.update(double(done) / double(stretches.size()));
  });
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "%s%04zu.jpg", kFrame, i + 1);
    std::error_code failure;
    fs::rename(best[i], folder / name, failure);
    if (failure)
      throw Error(
          concat((folder / name).string(), ": cannot be written (", failure.message(), ")"));
    frames.push_back(folder / name);
  }
  progress.finish();
  return frames;
}

}  // namespace photohull::cli

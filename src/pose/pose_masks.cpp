#include "pose/pose_masks.h"

#include <algorithm>
#include <atomic>
#include <set>
#include <string>

#include "calib/sheet_look.h"
#include "core/error.h"
#include "core/option_word.h"
#include "io/image_file.h"
#include "masks/sheet_mask.h"
#include "photo/for_photographs.h"

namespace photohull::pose {
namespace {

namespace fs = std::filesystem;
constexpr double kTexelsPerMm = 8;

/// Called as the photographs, or with a number before it where two would be called alike.
std::vector<std::string> mask_names(const std::vector<fs::path>& images) {
  std::multiset<std::string> stems;
  for (const fs::path& image : images) stems.insert(image.stem().string());
  std::vector<std::string> names;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const std::string stem = images[i].stem().string();
    names.push_back(stems.count(stem) == 1 ? stem + ".png" : concat(i, "_", stem, ".png"));
  }
  return names;
}

double pixels_of_largest(const PoseResult& result) {
  double most = 0;
  for (const PosedCamera& camera : result.cameras)
    most = std::max(most, double(camera.intrinsics.width) * camera.intrinsics.height);
  return most;
}

}  // namespace

std::vector<fs::path> write_sheet_masks(const fs::path& folder, const std::vector<fs::path>& images,
                                        const PhotoEdges& edges, const Sheet& sheet,
                                        const TurntableFinding& turntable,
                                        const SheetScenery& scenery, PoseResult& result,
                                        Progress& progress) {
  constexpr double kMuch = 0.2;
  make_scene_folder(folder);
  const SheetPicture picture = sheet_picture(sheet, kTexelsPerMm);
  const std::vector<std::string> names = mask_names(images);
  std::vector<fs::path> files(images.size());
  std::atomic<int> missing = 0, undecided = 0;
  const auto write_mask = [&](std::size_t i) {
    progress.check_cancelled();
    if (!result.photos[i].posed) return;
    SheetLook look =
        look_at_sheet(result, i, sheet, picture, blur_of_edges(edges[i]), scenery.light);
    scenery.narrow(i, look);
    turntable.note_hull(i, look);
    SheetMask found = mask_from_sheet(io::read_image(images[i]), look, turntable.behind(i));
    undecided += found.undecided > kMuch;
    if (found.mask.empty()) {
      ++missing;
      return;
    }
    turntable.keep_to_shadow(i, found.mask);
    if (!scenery.shadows.empty()) keep_parts_in(scenery.shadows[i], found.mask);
    keep_shares(found.mask);
    files[i] = folder / names[i];
    io::write_png(files[i], found.mask.width, found.mask.height, 1, found.mask.coverage);
  };
  // Some 110 bytes a pixel while a mask is made: a third of the photographs that others take.
  constexpr double kDear = 3;
  for_photographs(images.size(), kDear * pixels_of_largest(result), write_mask,
                  [&](std::size_t done) { progress.update(double(done) / double(images.size())); });
  if (missing > 0)
    result.warnings.push_back(
        concat(missing, " photographs get no mask: too little of the bare sheet is seen"));
  if (undecided > 0)
    result.warnings.push_back(concat(
        undecided,
        " photographs show much of what is behind the sheet, of many colours, where the object may "
        "be: their masks are too large there; give a lower ",
        option_word("height"), ", or look from higher up"));
  return files;
}

}  // namespace photohull::pose

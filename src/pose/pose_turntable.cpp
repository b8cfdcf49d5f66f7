#include "pose/pose_turntable.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "calib/sheet_hull.h"
#include "calib/sheet_look.h"
#include "core/image_scale.h"
#include "core/scaled_size.h"
#include "io/image_file.h"
#include "masks/sheet_mask.h"
#include "photo/for_photographs.h"
#include "pose/pose_scenery.h"

namespace photohull::pose {
namespace {

constexpr double kTexelsPerMm = 4;
constexpr double kSmall = 4e5;  // pixels of the pictures whose masks tell where the object can be
constexpr int kRounds = 2;

/// Backgrounds and shadows, in turn.
class TurntableSearch {
 public:
  TurntableSearch(const PoseJob& job, const Sheet& sheet, const PoseResult& result,
                  const PhotoEdges& edges, Progress& progress)
      : job_(job),
        sheet_(sheet),
        result_(result),
        edges_(edges),
        progress_(progress),
        picture_(sheet_picture(sheet, kTexelsPerMm)) {}

  TurntableFinding run() {
    out_.motion = find_turntable(result_);
    if (!out_.motion.found) return std::move(out_);
    out_.shadows.resize(job_.images.size());
    double scale = 1;
    for (const PosedCamera& c : result_.cameras)
      scale =
          std::min(scale, std::sqrt(kSmall / (double(c.intrinsics.width) * c.intrinsics.height)));
    steps_ = kRounds + 2;
    find_backgrounds(scale);
    if (!job_.make_masks || !out_.found()) return std::move(out_);
    for (int round = 0; round < kRounds; ++round) {
      masks_ = small_masks(scale);
      out_.shadows = shadows_of_hull(result_, masks_);
      find_backgrounds(scale);
    }
    if (scale < 1) find_backgrounds(1);
    return std::move(out_);
  }

 private:
  SheetLook look_at(std::size_t photo, int width, int height,
                    std::span<const LocalBlur> blur) const {
    const auto c = std::size_t(result_.photos[photo].camera);
    PoseResult scaled = result_;
    scaled.cameras[c].intrinsics = scaled_to(result_.cameras[c].intrinsics, width, height);
    return look_at_sheet(scaled, photo, sheet_, picture_, blur);
  }

  /// Of all stations, from pictures of that scale and by the shadows there are.
  void find_backgrounds(double scale) {
    std::vector<StillBackground> found;
    for (const TurntableStation& station : out_.motion.stations) {
      const Intrinsics& k = result_.cameras[std::size_t(station.camera)].intrinsics;
      StillPhotographs photos;
      photos.count = station.photos.size();
      photos.width = scaled_length(k.width, scale), photos.height = scaled_length(k.height, scale);
      photos.image = [&](std::size_t i) {
        progress_.check_cancelled();
        return io::read_image(job_.images[station.photos[i]], scale);
      };
      photos.look = [&](std::size_t i, int width, int height) {
        SheetLook look = look_at(station.photos[i], width, height, {});
        keep_to(out_.shadows[station.photos[i]], width, height, look.possible);
        return look;
      };
      if (!masks_.empty()) photos.mask = [&](std::size_t i) { return masks_[station.photos[i]]; };
      photos.progress = [&](double share) {
        const double part = (double(found.size()) + share) / double(out_.motion.stations.size());
        progress_.update((done_ + part) / steps_);
      };
      found.push_back(find_still_background(photos, job_.make_masks));
    }
    out_.stations = std::move(found);
    ++done_;
  }

  std::vector<Mask> small_masks(double scale) {
    std::vector<Mask> masks(job_.images.size());
    for_photographs(masks.size(), kSmall, [&](std::size_t i) {
      progress_.check_cancelled();
      if (out_.station_of(i) < 0) return;
      const ColourImage image = io::read_image(job_.images[i], scale);
      const SheetLook look = look_at(i, image.width, image.height, blur_of_edges(edges_[i], scale));
      masks[i] = mask_from_sheet(image, look, out_.behind(i)).mask;
    });
    return masks;
  }

  const PoseJob& job_;
  const Sheet& sheet_;
  const PoseResult& result_;
  const PhotoEdges& edges_;
  Progress& progress_;
  SheetPicture picture_;
  TurntableFinding out_;
  std::vector<Mask> masks_;  ///< of the last round
  double done_ = 0, steps_ = 1;
};

}  // namespace

const char* to_string(Stillness stillness) {
  switch (stillness) {
    case Stillness::kStill:
      return "still";
    case Stillness::kChanges:
      return "changes";
    case Stillness::kPlain:
      break;
  }
  return "plain";
}

std::string TurntableFinding::reason() const {
  if (stations.empty()) return motion.reason;
  const auto changes = [](const StillBackground& b) { return b.stillness == Stillness::kChanges; };
  if (std::ranges::any_of(stations, changes))
    return "what is behind the sheet changes from photograph to photograph, so that the camera "
           "went around";
  return "too little is seen behind the sheet to tell whether the camera stood still";
}

int TurntableFinding::photographs() const {
  std::size_t count = 0;
  for (std::size_t s = 0; s < stations.size(); ++s)
    if (stations[s].stillness == Stillness::kStill) count += motion.stations[s].photos.size();
  return int(count);
}

int TurntableFinding::station_of(std::size_t photo) const {
  for (std::size_t s = 0; s < stations.size(); ++s)
    if (stations[s].stillness == Stillness::kStill &&
        std::ranges::binary_search(motion.stations[s].photos, photo))
      return int(s);
  return -1;
}

const StillBackground& TurntableFinding::behind(std::size_t photo) const {
  static const StillBackground none;
  const int station = station_of(photo);
  return station < 0 ? none : stations[std::size_t(station)];
}

void TurntableFinding::note_hull(std::size_t photo, SheetLook& look) const {
  if (!shadows.empty()) pose::note_hull(shadows[photo], look);
}

void TurntableFinding::keep_to_shadow(std::size_t photo, Mask& mask) const {
  if (!shadows.empty()) keep_to(shadows[photo], mask.width, mask.height, mask.coverage);
}

TurntableFinding look_for_turntable(const PoseJob& job, const Sheet& sheet,
                                    const PoseResult& result, const PhotoEdges& edges,
                                    Progress& progress) {
  return TurntableSearch(job, sheet, result, edges, progress).run();
}

}  // namespace photohull::pose

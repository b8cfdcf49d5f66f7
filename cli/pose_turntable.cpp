#include "pose_turntable.h"

#include <algorithm>

#include "calib/sheet_look.h"
#include "io/image_file.h"

namespace photohull::cli {
namespace {

constexpr double kTexelsPerMm = 2;  // only the page's outline is asked for

/// The same with pictures of that many pixels.
PosedCamera resized(PosedCamera camera, int width, int height) {
  Intrinsics& k = camera.intrinsics;
  const double x = double(width) / k.width, y = double(height) / k.height;
  k.fx *= x, k.fy *= y, k.skew *= x;
  k.cx = (k.cx + 0.5) * x - 0.5, k.cy = (k.cy + 0.5) * y - 0.5;
  k.width = width, k.height = height;
  return camera;
}

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

TurntableFinding look_for_turntable(const PoseJob& job, const Sheet& sheet,
                                    const PoseResult& result, Progress& progress) {
  TurntableFinding out;
  out.motion = find_turntable(result);
  if (!out.motion.found) return out;
  const SheetPicture picture = sheet_picture(sheet, kTexelsPerMm);
  PoseResult resized_result = result;
  for (const TurntableStation& station : out.motion.stations) {
    const PosedCamera& camera = result.cameras[std::size_t(station.camera)];
    StillPhotographs photos;
    photos.count = station.photos.size();
    photos.width = camera.intrinsics.width, photos.height = camera.intrinsics.height;
    photos.image = [&](std::size_t k) {
      progress.check_cancelled();
      return io::read_image(job.images[station.photos[k]]);
    };
    photos.look = [&](std::size_t k, int width, int height) {
      resized_result.cameras[std::size_t(station.camera)] = resized(camera, width, height);
      return look_at_sheet(resized_result, station.photos[k], sheet, picture, 0);
    };
    photos.progress = [&](double share) {
      progress.update((double(out.stations.size()) + share) / double(out.motion.stations.size()));
    };
    out.stations.push_back(find_still_background(photos, job.make_masks));
  }
  return out;
}

}  // namespace photohull::cli

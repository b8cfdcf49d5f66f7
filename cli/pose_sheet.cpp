#include "pose_sheet.h"

#include <filesystem>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/scene.h"
#include "io/image_file.h"
#include "io/photo_lens.h"
#include "io/write_scene.h"
#include "pipeline/check_photographs.h"
#include "pose_json.h"
#include "pose_masks.h"
#include "scene_arguments.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;

/// A photograph that cannot be read has no tags, and this reason.
struct ReadPhotos {
  std::vector<PosePhoto> photos;
  std::vector<std::string> unreadable;  ///< of each: why; empty: it was read
  std::vector<pipeline::PhotoLook> looks;
};

ReadPhotos find_all_tags(const PoseJob& job, const Sheet& sheet, Progress& progress) {
  ReadPhotos read;
  progress.stage("tags", 0.4);
  for (std::size_t i = 0; i < job.images.size(); ++i) {
    progress.check_cancelled();
    progress.update(double(i) / double(job.images.size()));
    PosePhoto photo;
    photo.view.board.name = job.names[i];
    read.unreadable.emplace_back();
    read.looks.push_back({job.names[i]});
    try {
      const io::PhotoLens lens = io::read_photo_lens(job.images[i]);
      photo.camera = lens.name, photo.focal = lens.focal;
      read.looks.back().exposure = lens.exposure;
      photo.view = find_tags(io::read_image(job.images[i]), sheet, job.names[i]);
      if (photo.view.edge_width > 0) read.looks.back().sharpness = 1 / photo.view.edge_width;
    } catch (const MemoryError&) {
      throw;
    } catch (const Error& failure) {
      read.unreadable.back() = concat("it cannot be read: ", failure.what());
    }
    read.photos.push_back(std::move(photo));
  }
  return read;
}

Scene scene_of(const PoseJob& job, const PoseResult& result, const std::vector<fs::path>& masks) {
  Scene scene;
  scene.path = job.out;
  scene.format = SceneFormat::kTransforms;
  scene.box = result.box;
  for (std::size_t i = 0; i < job.images.size(); ++i) {
    const PosedPhoto& photo = result.photos[i];
    if (!photo.posed) continue;
    const PosedCamera& camera = result.cameras[std::size_t(photo.camera)];
    scene.views.push_back({job.names[i],
                           fs::absolute(job.images[i]).lexically_normal(),
                           masks.empty() ? fs::path() : masks[i],
                           {camera.intrinsics, photo.cam_from_world},
                           camera.distortion});
  }
  return scene;
}

}  // namespace

SheetPose pose_on_sheet(const PoseJob& job, Progress& progress) {
  const Sheet sheet = read_sheet(job.board);
  const ReadPhotos read = find_all_tags(job, sheet, progress);
  progress.stage("poses", 0.05);
  SheetPose pose{pose_photographs(read.photos, sheet, job.sheet), {}, ""};
  for (std::size_t i = 0; i < job.images.size(); ++i)
    if (!read.unreadable[i].empty()) pose.result.photos[i].reason = read.unreadable[i];
  progress.stage("background", 0.15);
  pose.turntable = look_for_turntable(job, sheet, pose.result, progress);
  make_folder(job.out, "--out");
  std::vector<fs::path> masks;
  if (job.make_masks) {
    progress.stage("masks", 0.4);
    std::vector<double> widths;
    for (const PosePhoto& photo : read.photos) widths.push_back(photo.view.edge_width);
    masks = write_sheet_masks(job.out / "masks", job.images, widths, sheet, pose.turntable,
                              pose.result, progress);
  }
  const Scene scene = scene_of(job, pose.result, masks);
  for (const std::string& warning : pipeline::check_photographs(
           read.looks, scene.views, scene.box->center(), glm::dvec3(0, 0, 1)))
    pose.result.warnings.push_back(warning);
  pose.report = pose_json(job.names, pose.result, pose.turntable);
  write_atomically(job.out / "pose.json", pose.report);
  io::write_transforms(scene, job.out);
  return pose;
}

}  // namespace photohull::cli

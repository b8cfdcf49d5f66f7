#include "pose/pose_sheet.h"

#include <atomic>
#include <filesystem>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/scene.h"
#include "io/image_file.h"
#include "io/photo_lens.h"
#include "io/write_scene.h"
#include "photo/for_photographs.h"
#include "pose/pose_coverage.h"
#include "pose/pose_json.h"
#include "pose/pose_masks.h"

namespace photohull::pose {
namespace {

namespace fs = std::filesystem;

/// A photograph that cannot be read has no tags, and this reason.
struct ReadPhotos {
  std::vector<PosePhoto> photos;
  std::vector<std::string> unreadable;  ///< of each: why; empty: it was read
  std::vector<pipeline::PhotoLook> looks;
  bool took_focal = false;  ///< the job's
};

ReadPhotos find_all_tags(const PoseJob& job, const Sheet& sheet, Progress& progress) {
  const std::size_t count = job.images.size();
  ReadPhotos read{std::vector<PosePhoto>(count), std::vector<std::string>(count), {}, false};
  for (const std::string& name : job.names) read.looks.push_back({name});
  std::atomic<bool> took_focal = false;
  progress.stage("tags", 0.4);
  const auto find_in = [&](std::size_t i) {
    progress.check_cancelled();
    PosePhoto& photo = read.photos[i];
    photo.view.board.name = job.names[i];
    try {
      const io::PhotoLens lens = io::read_photo_lens(job.images[i], job.focal);
      photo.camera = lens.name, photo.focal = lens.focal;
      if (lens.given) took_focal = true;
      read.looks[i].exposure = lens.exposure;
      photo.view = find_tags(io::read_image(job.images[i]), sheet, job.names[i]);
      if (photo.view.edge_width() > 0) read.looks[i].sharpness = 1 / photo.view.edge_width();
    } catch (const MemoryError&) {
      throw;
    } catch (const UsageError&) {
      throw;
    } catch (const Error& failure) {
      read.unreadable[i] = concat("it cannot be read: ", failure.what());
    }
  };
  for_photographs(count, io::pixels_of_largest(job.images), find_in,
                  [&](std::size_t done) { progress.update(double(done) / double(count)); });
  read.took_focal = took_focal;
  return read;
}

Scene scene_of(const PoseJob& job, const PoseResult& result, const std::vector<fs::path>& masks,
               bool has_box) {
  Scene scene;
  scene.path = job.out;
  scene.format = SceneFormat::kTransforms;
  if (has_box) scene.box = result.box;
  for (std::size_t i = 0; i < job.images.size(); ++i) {
    const PosedPhoto& photo = result.photos[i];
    if (!photo.posed) continue;
    const PosedCamera& camera = result.cameras[std::size_t(photo.camera)];
    scene.views.push_back({job.names[i],
                           fs::absolute(job.images[i]).lexically_normal(),
                           masks.empty() ? fs::path() : masks[i],
                           {camera.intrinsics, photo.cam_from_world},
                           camera.distortion});
    scene.views.back().mask_made = !scene.views.back().mask.empty();
  }
  return scene;
}

PosedSides sides_of(const PoseJob& job, const ReadPhotos& read, const PoseResult& result,
                    const Scene& scene) {
  PosedSides sides{read.looks, scene.views, result.box.center(), {0, 0, 1}, {}};
  for (std::size_t i = 0; i < job.images.size(); ++i) {
    const PosedPhoto& photo = result.photos[i];
    if (photo.posed) continue;
    SourceView view;
    view.name = job.names[i];
    view.camera.cam_from_world = photo.cam_from_world;
    sides.left_out.push_back(
        {view.name, photo.placed ? std::optional(place_of(sides, view)) : std::nullopt});
  }
  return sides;
}

}  // namespace

SheetPose pose_on_sheet(const PoseJob& job, Progress& progress) {
  const Sheet sheet = as_printed(read_sheet(job.board), job.sheet.bar);
  const ReadPhotos read = find_all_tags(job, sheet, progress);
  progress.stage("poses", 0.05);
  SheetPose pose{pose_photographs(read.photos, sheet, job.sheet), {}, "", {}};
  for (std::size_t i = 0; i < job.images.size(); ++i)
    if (!read.unreadable[i].empty()) pose.result.photos[i].reason = read.unreadable[i];
  PhotoEdges edges;
  for (const PosePhoto& photo : read.photos) edges.push_back(photo.view.edges);
  if (sheet.is_flat()) {
    progress.stage("background", 0.15);
    pose.turntable = look_for_turntable(job, sheet, pose.result, edges, progress);
  } else {
    pose.turntable.motion.reason = "a strip does not tell where the background behind it begins";
  }
  make_scene_folder(job.out);
  std::vector<fs::path> masks;
  if (job.make_masks && sheet.is_flat()) {
    SheetScenery scenery;
    if (!pose.turntable.found()) {  // there shadows do not stay where they are on the sheet
      progress.stage("light", 0.4);
      scenery = explore_sheet(job.images, read.photos, sheet, pose.result, progress);
    }
    progress.stage("masks", 0.4);
    masks = write_sheet_masks(job.out / "masks", job.images, edges, sheet, pose.turntable, scenery,
                              pose.result, progress);
  }
  if (const std::string warning = unused_focal(job, read.took_focal); !warning.empty())
    pose.result.warnings.push_back(warning);
  // What stands on a turntable lies above its strip, but a pot goes through it.
  const bool has_box = sheet.is_flat() || job.sheet.height > 0;
  pose.scene = scene_of(job, pose.result, masks, has_box);
  for (const std::string& warning :
       check_sides(job.out, sides_of(job, read, pose.result, pose.scene)))
    pose.result.warnings.push_back(warning);
  pose.report = pose_json(job.names, pose.result, pose.turntable);
  write_atomically(job.out / "pose.json", pose.report);
  io::write_transforms(pose.scene, job.out);
  return pose;
}

}  // namespace photohull::pose

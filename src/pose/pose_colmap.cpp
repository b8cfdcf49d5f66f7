#include "pose/pose_colmap.h"

#include <nlohmann/json.hpp>
#include <optional>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/image_file.h"
#include "io/photo_lens.h"
#include "io/write_scene.h"
#include "photo/fine_detail.h"
#include "photo/for_photographs.h"
#include "photo/grey_image.h"
#include "pose/json_parts.h"
#include "pose/pose_coverage.h"

namespace photohull::pose {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// The photographs that can be read, and where each is in the list of all.
struct Readable {
  std::vector<io::ColmapPhoto> photos;
  std::vector<std::size_t> index;
  std::vector<pipeline::PhotoLook> looks;  ///< of these
  bool took_focal = false;                 ///< the job's
};

Readable look_at_photographs(const PoseJob& job, const std::vector<fs::path>& masks,
                             std::vector<io::ColmapPhotoFound>& all, Progress& progress) {
  Readable readable;
  progress.stage("photographs", 0.1);
  const std::size_t count = job.images.size();
  std::vector<std::optional<io::PhotoLens>> lenses(count);
  std::vector<double> sharpness(count, 0.0);
  const auto look_at = [&](std::size_t i) {
    progress.check_cancelled();
    try {
      const io::PhotoLens lens = io::read_photo_lens(job.images[i], job.focal);
      sharpness[i] = fine_detail(grey_image(io::read_image(job.images[i])));
      lenses[i] = lens;
    } catch (const MemoryError&) {
      throw;
    } catch (const UsageError&) {
      throw;
    } catch (const Error& failure) {
      all[i].reason = concat("it cannot be read: ", failure.what());
    }
  };
  for_photographs(count, io::pixels_of_largest(job.images), look_at,
                  [&](std::size_t done) { progress.update(double(done) / double(count)); });
  for (std::size_t i = 0; i < count; ++i) {
    if (!lenses[i]) continue;
    const io::PhotoLens& lens = *lenses[i];
    readable.photos.push_back({job.images[i], masks.empty() ? fs::path() : masks[i], job.names[i],
                               lens.name, lens.given ? lens.focal : 0});
    readable.took_focal |= lens.given;
    readable.index.push_back(i);
    readable.looks.push_back({job.names[i], sharpness[i], lens.exposure});
  }
  return readable;
}

PosedSides sides_of(const PoseJob& job, const Readable& readable, const io::ColmapFound& found) {
  PosedSides sides{readable.looks, found.scene.views, {}, {}, {}};
  sides.middle = pipeline::find_middle(found.scene.views, found.scene.points);
  sides.up = pipeline::level_up(found.scene.views, sides.middle);
  for (std::size_t i = 0; i < job.names.size(); ++i)
    if (!found.photos[i].posed) sides.left_out.push_back({job.names[i], std::nullopt});
  return sides;
}

ordered_json lens_json(const AdjustedLens& lens) {
  const Intrinsics& k = lens.intrinsics;
  return {{"photographs", lens.views},
          {"width", k.width},
          {"height", k.height},
          {"focal_length", {k.fx, k.fy}},
          {"principal_point", {k.cx, k.cy}},
          {"distortion", lens.distortion.coefficients},
          {"focal_sigma", lens.focal_sigma},
          {"principal_point_sigma", {lens.principal_sigma.x, lens.principal_sigma.y}}};
}

std::string report_of(const PoseJob& job, const ColmapPose& pose) {
  const io::ColmapFound& found = pose.found;
  ordered_json j;
  j["photohull_pose"] = 1;
  j["with"] = "colmap";
  j["model"] = found.model.lexically_relative(job.out).generic_string();
  j["models"] = found.models;
  j["points"] = found.scene.points.size();
  j["warnings"] = pose.warnings;
  j["cameras"] = ordered_json::array();
  for (const AdjustedLens& lens : pose.lenses) j["cameras"].push_back(lens_json(lens));
  j["photographs"] = ordered_json::array();
  std::size_t next = 0;
  for (std::size_t i = 0; i < job.names.size(); ++i) {
    const io::ColmapPhotoFound& photo = found.photos[i];
    ordered_json one = {{"name", job.names[i]}, {"posed", photo.posed}};
    if (photo.features >= 0) one["features"] = photo.features;
    if (photo.posed) {
      const SourceView& view = found.scene.views[next];
      if (!pose.lenses.empty()) one["camera"] = found.lens_of_view[next];
      one["focal_length"] = {view.camera.intrinsics.fx, view.camera.intrinsics.fy};
      add_pose_json(view.camera.cam_from_world, one);
      ++next;
    } else {
      one["reason"] = photo.reason;
    }
    j["photographs"].push_back(std::move(one));
  }
  return j.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

ColmapPose pose_with_colmap(const PoseJob& job, Progress& progress) {
  std::vector<fs::path> masks;
  if (!job.masks.empty()) masks = io::find_masks(job.images, job.masks);
  std::vector<io::ColmapPhotoFound> all(job.images.size());
  const Readable readable = look_at_photographs(job, masks, all, progress);
  make_scene_folder(job.out);
  ColmapPose pose;
  pose.found = io::run_colmap({readable.photos, job.out / "colmap", job.ordered}, progress);
  for (std::size_t i = 0; i < readable.index.size(); ++i)
    all[readable.index[i]] = pose.found.photos[i];
  pose.found.photos = std::move(all);
  Scene& scene = pose.found.scene;
  progress.stage("lenses", 0.1);
  pose.lenses = adjust_lenses(scene, pose.found.lens_of_view, progress);
  scene.path = job.out;
  scene.format = SceneFormat::kTransforms;
  pose.warnings = check_sides(job.out, sides_of(job, readable, pose.found));
  if (const std::string warning = unused_focal(job, readable.took_focal); !warning.empty())
    pose.warnings.push_back(warning);
  pose.report = report_of(job, pose);
  write_atomically(job.out / "pose.json", pose.report);
  io::write_transforms(scene, job.out);
  return pose;
}

}  // namespace photohull::pose

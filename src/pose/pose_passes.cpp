#include "pose/pose_passes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "carving/object_box.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/image_scale.h"
#include "core/option_word.h"
#include "core/read_file.h"
#include "io/image_file.h"
#include "io/write_scene.h"
#include "views/undistort.h"

namespace photohull::pose {
namespace {

namespace fs = std::filesystem;

constexpr double kMostPixels = 3e6;  // of the photographs that features are looked for in
constexpr double kMostGrowth = 2;    // of frames by undistortion
constexpr double kBelow = 1;         // mm from the sheet down to the joined scene's box
constexpr double kJoinWeight = 0.5;  // beside a pass

std::vector<PosedPass> pose_each(const PoseJob& job, Progress& progress) {
  std::vector<PosedPass> passes;
  for (const PassOfPhotos& pass : job.passes) {
    PosedPass one{job, {}, {}};
    one.job.passes.clear();
    one.job.images = pass.images;
    for (const std::string& name : names_of(pass.images))
      one.job.names.push_back(concat(pass.name, "/", fs::path(name).filename().string()));
    one.job.out = job.out / concat("pass", passes.size() + 1);
    try {
      one.pose = pose_on_sheet(one.job, progress);
    } catch (const UsageError&) {
      throw;
    } catch (const MemoryError&) {
      throw;
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& failure) {
      throw Error(concat(pass.name, ": ", failure.what()));
    }
    passes.push_back(std::move(one));
  }
  return passes;
}

/// One for all photographs: passes are compared in pixels.
double scale_of(const std::vector<PosedPass>& passes) {
  double scale = 1;
  for (const PosedPass& pass : passes)
    for (const SourceView& view : pass.pose.scene.views) {
      const Intrinsics& k = view.camera.intrinsics;
      scale = std::min(scale, std::sqrt(kMostPixels / (double(k.width) * k.height)));
    }
  return scale;
}

PreparedView read_view(const SourceView& source, double scale) {
  PreparedView view;
  view.name = source.name;
  view.image = scale < 1 ? io::read_image(source.image, scale) : io::read_image(source.image);
  view.mask = scale < 1 ? io::read_mask(source.mask, scale) : io::read_mask(source.mask);
  view.camera = source.camera;
  view.camera.intrinsics = scaled_intrinsics(source.camera.intrinsics, scale);
  undistort(source.distortion, kMostGrowth, view);
  return view;
}

/// Photographs that have a mask.
PhotoPass photo_pass(const PosedPass& pass, const std::string& name, double scale,
                     Progress& progress) {
  std::vector<SourceView> sources;
  for (const SourceView& view : pass.pose.scene.views)
    if (!view.mask.empty()) sources.push_back(view);
  PhotoPass result{name, std::vector<PreparedView>(sources.size()), pass.pose.result.box};
  tbb::parallel_for(std::size_t(0), sources.size(), [&](std::size_t i) {
    if (!progress.cancelled()) result.views[i] = read_view(sources[i], scale);
  });
  progress.check_cancelled();
  return result;
}

/// In the first pass's world: what the boxes of all passes have in common, each from `bottom` up.
Box common_box(const std::vector<PosedPass>& passes, double bottom) {
  Box common;
  for (const PosedPass& pass : passes) {
    Box own = pass.pose.result.box;
    own.min.z = bottom;
    Box moved{glm::dvec3(INFINITY), glm::dvec3(-INFINITY)};
    for (int i = 0; i < 8; ++i) {
      const glm::dvec3 corner(i & 1 ? own.max.x : own.min.x, i & 2 ? own.max.y : own.min.y,
                              i & 4 ? own.max.z : own.min.z);
      const glm::dvec3 p = pass.joined.motion(corner);
      moved = {glm::min(moved.min, p), glm::max(moved.max, p)};
    }
    if (&pass == &passes.front()) common = moved;
    common = {glm::max(common.min, moved.min), glm::min(common.max, moved.max)};
  }
  return common;
}

/// What the masks of all passes leave of it: in its corners are places that hardly a photograph
/// shows.
Box object_in(const Box& box, const std::vector<PosedPass>& passes,
              const std::vector<PhotoPass>& photos) {
  std::vector<PreparedView> views;
  for (std::size_t i = 0; i < passes.size(); ++i)
    for (const PreparedView& view : photos[i].views) {
      views.push_back(view);
      views.back().camera = passes[i].joined.motion.moved(view.camera);
    }
  return carving::object_box(box, views);
}

/// Returns the box that holds the object, in the first pass's world.
Box join(const PoseJob& job, std::vector<PosedPass>& passes, Progress& progress) {
  progress.stage("joining", kJoinWeight);
  const double scale = scale_of(passes);
  std::vector<PhotoPass> photos;
  for (std::size_t i = 0; i < passes.size(); ++i)
    photos.push_back(photo_pass(passes[i], job.passes[i].name, scale, progress));
  const std::vector<JoinedPass> joined = join_passes(photos, progress);
  for (std::size_t i = 0; i < passes.size(); ++i) {
    passes[i].joined = joined[i];
    passes[i].joined.seam /= scale, passes[i].joined.seam_sigma /= scale;
  }
  return object_in(common_box(passes, -kBelow / job.sheet.unit), passes, photos);
}

Scene scene_of_all(const PoseJob& job, const std::vector<PosedPass>& passes, const Box& box) {
  Scene scene;
  scene.path = job.out;
  scene.format = SceneFormat::kTransforms;
  for (const PosedPass& pass : passes)
    for (SourceView view : pass.pose.scene.views) {
      view.camera = pass.joined.motion.moved(view.camera);
      scene.views.push_back(std::move(view));
    }
  scene.box = box;
  return scene;
}

/// A photograph of a pass.
struct PassImage {
  std::size_t pass;
  fs::path file;
};

/// Photographs by their files' sizes; without those that cannot be read, which are told elsewhere.
std::map<std::uintmax_t, std::vector<PassImage>> images_by_size(const PoseJob& job) {
  std::map<std::uintmax_t, std::vector<PassImage>> all;
  for (std::size_t i = 0; i < job.passes.size(); ++i)
    for (const fs::path& image : job.passes[i].images) {
      std::error_code unknown;
      const std::uintmax_t size = fs::file_size(image, unknown);
      if (!unknown) all[size].push_back({i, image});
    }
  return all;
}

/// Throws Error where a photograph was given for two passes.
void refuse_twice(const PoseJob& job) {
  for (const auto& [size, images] : images_by_size(job)) {
    if (images.front().pass == images.back().pass) continue;
    std::map<std::size_t, PassImage> by_content;
    for (const PassImage& image : images) {
      const std::size_t content = std::hash<std::string>{}(read_whole_file(image.file));
      const auto [other, is_new] = by_content.try_emplace(content, image);
      if (is_new || other->second.pass == image.pass) continue;
      throw Error(concat(image.file.string(), " and ", other->second.file.string(),
                         " are the same photograph: ", option_word("pass"),
                         " takes a folder for each side that the object lay on, each with "
                         "photographs of its own"));
    }
  }
}

/// Degrees by which the second world's upright axis is tilted in the first.
double tilt(const RigidMotion& motion) {
  return glm::degrees(std::acos(std::clamp(motion.rotation[2].z, -1.0, 1.0)));
}

/// Names passes whose sheet lies against the same side of the object, if all do.
void warn_of_one_side(const PoseJob& job, const std::vector<PosedPass>& passes,
                      std::vector<std::string>& warnings) {
  constexpr double kSameSide = 15;  // degrees
  double most = 0;
  for (const PosedPass& pass : passes) most = std::max(most, tilt(pass.joined.motion));
  if (most < kSameSide)
    warnings.push_back(concat("the object lay on the same side in all passes (tilted by ",
                              std::round(10 * most) / 10, " degrees at most between ",
                              job.passes.front().name,
                              " and another): what it stood on is seen in none; lay it on its side "
                              "for one of them"));
}

std::vector<std::string> warnings_of(const PoseJob& job, const std::vector<PosedPass>& passes) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < passes.size(); ++i)
    for (const std::string& text : passes[i].pose.result.warnings)
      all.push_back(concat(job.passes[i].name, ": ", text));
  warn_of_one_side(job, passes, all);
  return all;
}

}  // namespace

PassesPose pose_passes(const PoseJob& job, Progress& progress) {
  if (!read_sheet(job.board).is_flat())
    throw Error(concat(job.board.string(),
                       ": a strip around a cylinder gives no masks, by which passes are joined; ",
                       option_word("pass"), " is for objects on a flat sheet"));
  refuse_twice(job);
  PassesPose found;
  found.passes = pose_each(job, progress);
  const Box box = join(job, found.passes, progress);
  const Scene scene = scene_of_all(job, found.passes, box);
  found.warnings = warnings_of(job, found.passes);
  found.report = passes_json(found.passes, scene, found.warnings);
  write_atomically(job.out / "pose.json", found.report);
  io::write_transforms(scene, job.out);
  return found;
}

double passes_weight(const PoseJob& job) { return double(job.passes.size()) + kJoinWeight; }

}  // namespace photohull::pose

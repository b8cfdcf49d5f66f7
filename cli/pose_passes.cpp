#include "pose_passes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/image_scale.h"
#include "io/image_file.h"
#include "io/write_scene.h"
#include "pose_photos.h"
#include "terminal_progress.h"
#include "views/undistort.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kMostPixels = 3e6;  // of the photographs that features are looked for in
constexpr double kMostGrowth = 2;    // of frames by undistortion
constexpr double kBelow = 1;         // mm from the sheet down to the joined scene's box
constexpr double kJoinWeight = 0.5;  // beside a pass

std::vector<PosedPass> pose_each(const PoseJob& job, TerminalProgress& progress) {
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

void join(const PoseJob& job, std::vector<PosedPass>& passes, TerminalProgress& progress) {
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
}

Scene scene_of_all(const PoseJob& job, const std::vector<PosedPass>& passes) {
  Scene scene;
  scene.path = job.out;
  scene.format = SceneFormat::kTransforms;
  for (const PosedPass& pass : passes)
    for (SourceView view : pass.pose.scene.views) {
      view.camera = pass.joined.motion.moved(view.camera);
      scene.views.push_back(std::move(view));
    }
  Box box = passes.front().pose.result.box;
  box.min.z = -kBelow / job.sheet.unit;
  scene.box = box;
  return scene;
}

std::vector<std::string> warnings_of(const PoseJob& job, const std::vector<PosedPass>& passes) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < passes.size(); ++i)
    for (const std::string& text : passes[i].pose.result.warnings)
      all.push_back(concat(job.passes[i].name, ": ", text));
  return all;
}

}  // namespace

std::string pose_passes(const PoseJob& job, bool tell) {
  if (!read_sheet(job.board).is_flat())
    throw Error(concat(job.board.string(),
                       ": a strip around a cylinder gives no masks, by which passes are joined; "
                       "--pass is for objects on a flat sheet"));
  TerminalProgress progress(double(job.passes.size()) + kJoinWeight);
  std::vector<PosedPass> passes = pose_each(job, progress);
  join(job, passes, progress);
  progress.finish();
  const Scene scene = scene_of_all(job, passes);
  const std::vector<std::string> warnings = warnings_of(job, passes);
  const std::string report = passes_json(passes, scene, warnings);
  write_atomically(job.out / "pose.json", report);
  io::write_transforms(scene, job.out);
  print_warnings(warnings);
  if (tell) {
    print_passes(passes);
    std::printf("  %s\n", job.out.c_str());
  }
  return report;
}

}  // namespace photohull::cli

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "info_output.h"
#include "pipeline/plan.h"

namespace photohull::cli {
namespace {

struct Range {
  double low = 1e300, high = -1e300;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

void print_views(const Scene& scene) {
  Range focal, width, height;
  int distorted = 0, masked = 0;
  for (const SourceView& view : scene.views) {
    focal.add(view.camera.intrinsics.fx);
    width.add(view.camera.intrinsics.width);
    height.add(view.camera.intrinsics.height);
    distorted += view.distortion.model != DistortionModel::kNone;
    masked += !view.mask.empty();
  }
  std::printf("views          %zu", scene.views.size());
  if (scene.listed.size() > scene.views.size()) std::printf(" of %zu", scene.listed.size());
  std::printf(" (%s format)\n", to_string(scene.format));
  std::printf("image size     %.0f x %.0f", width.low, height.low);
  if (width.low != width.high || height.low != height.high)
    std::printf(" to %.0f x %.0f", width.high, height.high);
  std::printf(" pixels\nfocal length   %.1f", focal.low);
  if (focal.low != focal.high) std::printf(" to %.1f", focal.high);
  std::printf(" pixels\ndistortion     %d of %zu views\nmask files     %d of %zu views\n",
              distorted, scene.views.size(), masked, scene.views.size());
}

std::string corners(const Box& b) {
  char text[160];
  std::snprintf(text, sizeof text, "(%g %g %g) to (%g %g %g)", b.min.x, b.min.y, b.min.z, b.max.x,
                b.max.y, b.max.z);
  return text;
}

void print_extents(const pipeline::Inspection& info) {
  const pipeline::Extents& e = info.extents;
  std::printf("cameras at     %s\n", corners(e.cameras).c_str());
  if (!e.points.empty()) std::printf("sparse points  %zu\n", info.scene.points.size());
  for (const pipeline::Extents::Share& s : e.points)
    std::printf("  %2.0f to %3.0f %%  %s\n", 100 * s.low, 100 * s.high, corners(s.box).c_str());
  if (!info.suggested_box) return;
  const Box& b = *info.suggested_box;
  std::printf("suggestion     --box \"%.6g %.6g %.6g %.6g %.6g %.6g\", or --box auto\n", b.min.x,
              b.min.y, b.min.z, b.max.x, b.max.y, b.max.z);
}

void print_scene(const pipeline::Inspection& info) {
  print_views(info.scene);
  if (info.scene.box) {
    std::printf("box            %s, %s%s\n", corners(*info.scene.box).c_str(),
                info.scene.box_source.starts_with("found") ? "" : "from ",
                info.scene.box_source.c_str());
  }
  print_extents(info);
  if (!info.scales.empty()) {
    const glm::ivec3 n = info.grid.voxels();
    std::printf("view angles    %.1f degrees to the nearest (median), %.1f at most\n",
                info.nearest_angle, info.farthest_angle);
    std::printf("pixel          %g world units at the box's centre\n", info.voxel_size);
    std::printf("voxels         %d x %d x %d of %g\n", n.x, n.y, n.z, info.grid.voxel_size);
    std::printf("image scale    %s", pipeline::smallest_scale_text(info.scales).c_str());
    if (info.matched != info.scales)
      std::printf(", and %s for some at a time, in which the surface is matched",
                  pipeline::smallest_scale_text(info.matched).c_str());
    std::printf("\n");
    std::printf("estimate       %lld MiB, %.0f CPU seconds (software rasterizer)\n",
                static_cast<long long>(info.memory_bytes >> 20), info.cpu_seconds);
  }
  for (const std::string& text : info.warnings) std::printf("warning: %s\n", text.c_str());
}

void print_readings(const CameraDiagnosis& d) {
  if (d.readings.empty()) return;
  const auto print = [](const char* name, const PoseReading& r) {
    std::printf("%-14s %s: explains %.0f %% of the matches", name, to_string(r).c_str(),
                100 * r.explained);
    if (std::isfinite(r.residual))
      std::printf(", median %.2f px from the epipolar lines", r.residual);
    std::printf("\n");
  };
  std::printf("matches        %d features in %d pairs of views\n", d.matches, d.pairs);
  print("poses", d.given);
  print(d.misread ? "better" : "next best", d.readings[d.readings[0].as_given() ? 1 : 0]);
}

void print_diagnosis(const CameraDiagnosis& d, const Scene& scene) {
  print_readings(d);
  if (!d.views.empty()) {
    std::size_t worst = 0;
    for (std::size_t i = 0; i < d.views.size(); ++i)
      if (d.views[i].residual > d.views[worst].residual) worst = i;
    std::printf("agreement     ");
    if (d.usual_residual > 0)
      std::printf(" matches %.2f px from the epipolar lines (median view);", d.usual_residual);
    std::printf(" at worst %s, %.2f px\n", scene.views[worst].name.c_str(),
                d.views[worst].residual);
  }
  if (d.pixel_centre) {
    const PixelCentreFit& f = *d.pixel_centre;
    std::printf("pixel centre   ");
    if (f.tells)
      std::printf("%s fits", f.best == 0 ? "as given" : f.best > 0 ? "+0.5 px" : "-0.5 px");
    else
      std::printf("none clearly fits");
    if (std::isfinite(f.sigma)) std::printf(": best shift %+.3f +- %.3f px", f.shift, f.sigma);
    std::printf("\n");
    const auto print = [](const char* name, const std::array<double, 3>& rms, int count) {
      if (count > 0)
        std::printf("  %-12s %.3f, %.3f, %.3f px rms for -0.5, 0, +0.5 px (%d)\n", name, rms[0],
                    rms[1], rms[2], count);
    };
    print("tracks", f.tracks, f.track_count);
    print("silhouettes", f.tangents, f.tangent_count);
  }
  if (d.box && d.box->points > 0)
    std::printf("box holds      %.0f %% of %d matched points; diagonal %.3g, theirs %.3g\n",
                100 * d.box->points_inside, d.box->points, d.box->diagonal, d.box->points_diagonal);
  for (const std::string& text : d.notes) std::printf("note: %s\n", text.c_str());
  for (const std::string& text : d.faults) std::printf("fault: %s\n", text.c_str());
  if (d.faults.empty()) std::printf("cameras        no fault found\n");
}

void print_masks(const PreparedViews& prepared) {
  std::printf("masks          %s", prepared.mask_source.c_str());
  double least = 2, sum = 0;
  std::size_t worst = 0, count = 0;
  for (std::size_t i = 0; i < prepared.masks.size(); ++i) {
    if (prepared.views[i].mask.empty()) continue;
    const double c = prepared.masks[i].confidence;
    sum += c, ++count;
    if (c < least) least = c, worst = i;
  }
  if (count > 0)
    std::printf(": confidence %.2f in the mean, %.2f at least (%s)", sum / double(count), least,
                prepared.views[worst].name.c_str());
  std::printf("\n");
  for (const std::string& text : prepared.warnings) std::printf("warning: %s\n", text.c_str());
}

}  // namespace

void print_info_text(const pipeline::Inspection& info, const PreparedViews* masks,
                     const CameraDiagnosis* diagnosis) {
  print_scene(info);
  if (masks) print_masks(*masks);
  if (diagnosis) print_diagnosis(*diagnosis, info.scene);
}

}  // namespace photohull::cli

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "pipeline/inspect.h"
#include "scene_arguments.h"

namespace photohull::cli {
namespace {

struct Arguments {
  SceneArguments scene;
  bool json = false;
};

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
  std::printf("views          %zu (%s format)\n", scene.views.size(), to_string(scene.format));
  std::printf("image size     %.0f x %.0f", width.low, height.low);
  if (width.low != width.high || height.low != height.high)
    std::printf(" to %.0f x %.0f", width.high, height.high);
  std::printf(" pixels\nfocal length   %.1f", focal.low);
  if (focal.low != focal.high) std::printf(" to %.1f", focal.high);
  std::printf(" pixels\ndistortion     %d of %zu views\nmask files     %d of %zu views\n",
              distorted, scene.views.size(), masked, scene.views.size());
}

void print_text(const pipeline::Inspection& info) {
  print_views(info.scene);
  if (info.scene.box) {
    const Box& b = *info.scene.box;
    const glm::ivec3 n = info.grid.voxels();
    std::printf("box            (%g %g %g) to (%g %g %g), from %s\n", b.min.x, b.min.y, b.min.z,
                b.max.x, b.max.y, b.max.z, info.scene.box_source.c_str());
    std::printf("view angles    %.1f degrees to the nearest (median), %.1f at most\n",
                info.nearest_angle, info.farthest_angle);
    std::printf("pixel          %g world units at the box's centre\n", info.voxel_size);
    std::printf("normal quality %d x %d x %d voxels of %g\n", n.x, n.y, n.z, info.grid.voxel_size);
    std::printf("estimate       %lld MiB, %.0f CPU seconds (normal quality, software rasterizer)\n",
                static_cast<long long>(info.memory_bytes >> 20), info.cpu_seconds);
  }
  for (const std::string& text : info.warnings) std::printf("warning: %s\n", text.c_str());
}

void print_json(const pipeline::Inspection& info) {
  nlohmann::ordered_json j;
  j["format"] = to_string(info.scene.format);
  for (const SourceView& v : info.scene.views) {
    const Intrinsics& k = v.camera.intrinsics;
    const glm::dvec3 c = v.camera.center();
    j["views"].push_back({{"name", v.name},
                          {"width", k.width},
                          {"height", k.height},
                          {"fx", k.fx},
                          {"fy", k.fy},
                          {"skew", k.skew},
                          {"cx", k.cx},
                          {"cy", k.cy},
                          {"centre", {c.x, c.y, c.z}},
                          {"mask", v.mask.string()}});
  }
  if (info.scene.box) {
    const Box& b = *info.scene.box;
    j["box"] = {{"min", {b.min.x, b.min.y, b.min.z}},
                {"max", {b.max.x, b.max.y, b.max.z}},
                {"source", info.scene.box_source}};
    j["nearest_angle_degrees"] = info.nearest_angle;
    j["farthest_angle_degrees"] = info.farthest_angle;
    j["pixel_footprint"] = info.voxel_size;
    j["normal_voxel_size"] = info.grid.voxel_size;
    j["memory_bytes"] = info.memory_bytes;
    j["cpu_seconds"] = info.cpu_seconds;
  }
  j["warnings"] = info.warnings;
  std::printf("%s\n",
              j.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
}

}  // namespace

void add_info(CLI::App& app) {
  auto a = std::make_shared<Arguments>();
  CLI::App* c = app.add_subcommand("info", "tell what was understood of a scene");
  a->scene.add_to(*c);
  c->add_flag("--json", a->json, "print JSON");
  c->footer(
      "Examples:\n"
      "  photohull info datasets/templeSparseRing\n"
      "  photohull info colmap/sparse/0 --box \"-1 -1 0 1 1 2\" --json");
  c->callback([a] {
    const auto info = pipeline::inspect(io::load_scene(a->scene.scene, a->scene.options()));
    a->json ? print_json(info) : print_text(info);
  });
}

}  // namespace photohull::cli

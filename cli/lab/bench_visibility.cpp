#include "cli/lab/bench_visibility.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/option_flags.h"
#include "cli/terminal_progress.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "gpu/context.h"
#include "gpu/device_options.h"
#include "io/image_file.h"
#include "lab/chart/png.h"
#include "lab/chart/sampling_chart.h"
#include "lab/chart/svg_renderer.h"
#include "lab/visibility/study.h"

namespace photohull::cli {
namespace {

using nlohmann::ordered_json;
using visibility::Study;
using visibility::StudyCell;
using visibility::VisibilityErrors;

constexpr int kCropEdge = 220;  // pixels of a picture of errors

struct VisibilityArguments {
  std::string json, out;
  gpu::DeviceOptions device;
  visibility::StudyOptions options;
  bool quick = false;
};

double rounded(double value) { return std::round(value * 1e4) / 1e4; }

void put(ordered_json& j, const VisibilityErrors& e) {
  j["false_occlusion_percent"] = rounded(e.false_occlusion);
  j["false_visibility_percent"] = rounded(e.false_visibility);
}

ordered_json to_json(const Study& study, const VisibilityArguments& a, const std::string& device) {
  ordered_json j;
  j["device"] = device;
  j["receivers"] = {{"width", a.options.width}, {"height", a.options.height}};
  for (const auto& s : study.scenes)
    j["scenes"].push_back({{"name", s.name},
                           {"triangles", s.triangles},
                           {"vertices", s.vertices},
                           {"receivers", s.receivers},
                           {"visible_percent", rounded(s.visible_percent)}});
  for (const StudyCell& c : study.cells) {
    ordered_json cell{{"scene", c.scene}, {"technique", c.technique}, {"resolution", c.resolution}};
    put(cell, c.errors);
    cell["silhouette_texels"] = rounded(c.silhouette_texels);
    cell["map_ms"] = rounded(c.map_ms);
    cell["test_ms"] = rounded(c.test_ms);
    cell["bytes"] = c.bytes;
    j["cells"].push_back(cell);
  }
  for (const auto& c : study.biases) {
    ordered_json cell{
        {"scene", c.scene}, {"resolution", c.resolution}, {"bias_texels", c.bias_texels}};
    put(cell, c.errors);
    j["biases"].push_back(cell);
  }
  for (const auto& c : study.angles) {
    ordered_json cell{{"degrees", c.degrees}, {"technique", c.technique}, {"warped", c.warped}};
    put(cell, c.errors);
    cell["silhouette_texels"] = rounded(c.silhouette_texels);
    j["angles"].push_back(cell);
  }
  for (const auto& c : study.detection)
    j["detection"].push_back({{"scene", c.scene},
                              {"technique", c.technique},
                              {"resolution", c.resolution},
                              {"triangles_per_texel", rounded(c.per_texel)},
                              {"found_percent", rounded(c.found_percent)}});
  for (const auto& c : study.volumes) {
    ordered_json cell{{"way", c.way}, {"resolution", c.resolution}, {"map_ms", rounded(c.map_ms)}};
    put(cell, c.errors);
    j["volumes"].push_back(cell);
  }
  for (const auto& c : study.left_out)
    j["left_out"].push_back({{"scene", c.scene},
                             {"technique", c.technique},
                             {"resolution", c.resolution},
                             {"why", c.why}});
  for (const auto& c : study.views)
    j["views"].push_back({{"scene", c.scene}, {"close", c.close}, {"ms", rounded(c.ms)}});
  return j;
}

void print_table(const Study& study) {
  std::printf("%-14s %-20s %5s | %9s %9s %9s | %9s %9s %9s\n", "scene", "technique", "texels",
              "occlusion", "visible", "silhouet.", "map ms", "test ms", "MiB");
  for (const StudyCell& c : study.cells)
    std::printf("%-14s %-20s %5d | %8.3f%% %8.3f%% %9.3f | %9.1f %9.1f %9.1f\n", c.scene.c_str(),
                c.technique.c_str(), c.resolution, c.errors.false_occlusion,
                c.errors.false_visibility, c.silhouette_texels, c.map_ms, c.test_ms,
                double(c.bytes) / (1 << 20));
  for (const auto& c : study.left_out)
    std::printf("left out: %s, %s, %d: %s\n", c.scene.c_str(), c.technique.c_str(), c.resolution,
                c.why.c_str());
  std::printf("occlusion, visible: falsely hidden and falsely visible share of the receivers\n");
}

/// Techniques that the plot shows: all of them would hide one another.
bool is_drawn(const std::string& name) {
  for (const char* shown : {"plain", "slope-bias", "dual-depth", "receiver-plane", "virtual-normal",
                            "variance", "pcf5", "recommended", "sub-pixel", "coverage", "lists"})
    if (name == shown) return true;
  return false;
}

void draw_errors(const Study& study, const std::filesystem::path& folder) {
  std::vector<chart::SamplingPanel> panels;
  for (const auto& scene : study.scenes) {
    if (scene.name == "assembly_480k" || scene.name == "ball") continue;
    chart::SamplingPanel panel{scene.name, {}};
    for (const StudyCell& c : study.cells) {
      if (c.scene != scene.name || !is_drawn(c.technique)) continue;
      auto curve = std::find_if(panel.curves.begin(), panel.curves.end(),
                                [&](const auto& known) { return known.name == c.technique; });
      if (curve == panel.curves.end())
        curve = panel.curves.insert(curve, chart::SamplingCurve{c.technique, "", {}});
      curve->points.emplace_back(c.resolution, std::max(c.errors.total(), 1e-3));
    }
    if (!panel.curves.empty()) panels.push_back(std::move(panel));
  }
  if (panels.empty()) return;
  const chart::Chart drawn =
      chart::sampling_chart("Visibility against exact rays", panels,
                            {"map (texels)", "falsely hidden and falsely visible (%)", 1, "1 %"});
  const std::string svg = chart::SvgRenderer().render(drawn.option, drawn.width, drawn.height);
  write_atomically(folder / "visibility.svg", svg);
  chart::write_png(svg, 2 * drawn.width, 2 * drawn.height, folder / "visibility.png");
}

/// A row a scene, a column a technique.
void draw_crops(gpu::Context& context, const VisibilityArguments& a,
                const std::filesystem::path& folder) {
  const std::vector<std::string> techniques{"plain", "second-depth", "dual-depth", "variance",
                                            "pcf5",  "sub-pixel",    "coverage",   "lists"};
  constexpr int kGap = 4;
  const int columns = int(techniques.size()), rows = int(a.options.scenes.size());
  const int width = columns * (kCropEdge + kGap), height = rows * (kCropEdge + kGap);
  std::vector<std::uint8_t> sheet(std::size_t(width) * height * 3, 255);
  for (int row = 0; row < rows; ++row) {
    const auto scene = visibility::make_study_scene(a.options.scenes[std::size_t(row)]);
    for (int column = 0; column < columns; ++column) {
      visibility::Technique t =
          visibility::parse_technique("technique", techniques[std::size_t(column)]);
      t.resolution = std::min(1024, a.options.resolutions.back());
      const auto crop = visibility::picture_errors(context, scene, t, kCropEdge);
      for (int y = 0; y < kCropEdge; ++y)
        std::copy_n(&crop.rgb[std::size_t(y) * kCropEdge * 3], kCropEdge * 3,
                    &sheet[(std::size_t(row * (kCropEdge + kGap) + y) * width +
                            std::size_t(column) * (kCropEdge + kGap)) *
                           3]);
    }
  }
  io::write_png(folder / "visibility_crops.png", width, height, 3, sheet);
}

void run_visibility(VisibilityArguments a) {
  if (a.quick) {
    a.options.scenes = {"ball"};
    a.options.resolutions = {128};
    a.options.width = 80, a.options.height = 60;
    a.options.silhouettes = 40;
    a.options.volume_bricks = 8;
    a.options.repeats = 1;
  }
  a.options.validate();
  const auto context = gpu::Context::create(a.device.device, a.device.threads);
  TerminalProgress progress(1);
  progress.stage("visibility", 1);
  const Study study = study_visibility(*context, a.options, progress);
  progress.finish();
  print_table(study);
  const std::string text = to_json(study, a, context->device().renderer).dump(1) + "\n";
  if (!a.json.empty()) write_atomically(a.json, text);
  if (a.out.empty()) return;
  const std::filesystem::path folder = a.out;
  std::filesystem::create_directories(folder);
  write_atomically(folder / "visibility.json", text);
  draw_errors(study, folder);
  draw_crops(*context, a, folder);
  std::printf("\n  %s/visibility.json, visibility.svg, visibility.png and visibility_crops.png\n",
              a.out.c_str());
}

}  // namespace

void add_bench_visibility(CLI::App& bench) {
  auto a = std::make_shared<VisibilityArguments>();
  CLI::App* s = bench.add_subcommand(
      "visibility", "errors against exact rays, and costs, of the ways to tell who sees what");
  s->add_option("--json", a->json, "file for all figures");
  s->add_option("--out", a->out, "folder for visibility.json, a plot and crops of pictures");
  add_flags_of(*s, a->options, {"scenes", "resolutions", "techniques", "repeats"});
  s->add_flag("--quick", a->quick, "one small scene and map: shows that all works, no more");
  add_flags_of(*s, a->device);
  s->footer(
      "Truth is by exact rays from the viewpoint to what a second camera sees. Times on software "
      "devices\n"
      "are processor time. docs/measurements/visibility.md explains the techniques and has the "
      "results.\n\n"
      "Examples:\n"
      "  photohull bench visibility --quick\n"
      "  photohull bench visibility --scenes leaves,wires --resolutions 1024 --out out/visibility");
  s->callback([a] { run_visibility(*a); });
}

}  // namespace photohull::cli

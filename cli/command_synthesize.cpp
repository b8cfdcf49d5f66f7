#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "batch/pieces.h"
#include "cli/front/command_table.h"
#include "commands.h"
#include "core/error.h"
#include "gpu/device_options.h"
#include "option_flags.h"
#include "synth/synthesize.h"
#include "terminal_progress.h"

namespace photohull::cli {
namespace {

struct SynthesizeArguments {
  std::string spec, out, frames;
  gpu::DeviceOptions device;
  std::optional<std::string> size;
  std::optional<int> views;
  std::optional<std::uint64_t> seed;
  bool list = false;
};

void print_shapes() {
  for (const synth::Shape& shape : synth::shapes()) {
    std::printf("%s: %s\n", shape.name, shape.summary);
    for (const synth::ShapeParameter& p : shape.parameters)
      std::printf("  %-10s %-7g %g to %g; %s\n", p.name, p.value, p.low, p.high, p.help);
  }
}

void set_size(const std::string& text, synth::ImageSpec& image) {
  int used = 0;
  const bool read = std::sscanf(text.c_str(), "%5dx%5d%n", &image.width, &image.height, &used) == 2;
  if (!read || std::size_t(used) != text.size() || image.width < 8 || image.height < 8 ||
      image.width > synth::kLargestImage || image.height > synth::kLargestImage)
    throw UsageError(concat("--size ", text, ": expected WIDTHxHEIGHT in pixels, each from 8 to ",
                            synth::kLargestImage, ", such as 640x480"));
}

synth::Spec read_spec(const SynthesizeArguments& a) {
  synth::Spec spec = synth::read_spec(a.spec);
  if (a.size) set_size(*a.size, spec.image);
  if (a.views) synth::set_view_count(spec.cameras, *a.views);
  if (a.seed) spec.seed = *a.seed;
  // Overrides may ask together for what no single one does.
  return synth::parse_spec(synth::spec_text(spec), a.spec, "");
}

void print_end(const SynthesizeArguments& a, const synth::SynthesizedScene& made) {
  if (!made.middlebury)
    std::printf("lens distortion: no Middlebury cameras, which cannot express it\n");
  std::printf("  %s\n", a.out.c_str());
}

void run_frames(const SynthesizeArguments& a, const synth::Spec& spec) {
  const auto range = batch::parse_frames(a.frames);
  if (!range)
    throw UsageError("--frames " + a.frames +
                     ": give the first and the last, such as 0-59 or 0000-0059");
  std::vector<std::filesystem::path> folders;
  for (int frame = range->first; frame <= range->last; ++frame)
    folders.push_back(std::filesystem::path(a.out) / range->text(frame));
  TerminalProgress progress(synth::sequence_weight(spec, int(folders.size())));
  const std::vector<synth::SynthesizedScene> made =
      synth::synthesize_frames(spec, folders, progress, a.device.device, a.device.threads);
  progress.finish();
  double least_seen = 1, largest_fill = 0;
  for (const synth::SynthesizedScene& scene : made) {
    least_seen = std::min(least_seen, scene.seen);
    largest_fill = std::max(largest_fill, scene.largest_fill);
  }
  std::printf("%zu frames of %d views, %g across; the object covers up to %.0f %% of a picture\n",
              made.size(), made.front().views, made.front().diagonal, 100 * largest_fill);
  std::printf("in each at least %.1f %% of the surface is seen by a camera\n", 100 * least_seen);
  print_end(a, made.front());
}

void run_synthesize(const SynthesizeArguments& a) {
  if (a.list) return print_shapes();
  if (a.spec.empty())
    throw UsageError("a spec is missing: give a JSON file, or --list; see --help");
  if (a.out.empty()) throw UsageError("--out is missing: give the folder for the scene");
  std::optional<tbb::global_control> limit;
  if (a.device.threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, a.device.threads);
  const synth::Spec spec = read_spec(a);
  if (!a.frames.empty()) return run_frames(a, spec);
  TerminalProgress progress(synth::total_weight(spec));
  const synth::SynthesizedScene made =
      synth::synthesize(spec, a.out, progress, a.device.device, a.device.threads);
  progress.finish();
  std::printf("%d views of %zu triangles, %g across; the object covers up to %.0f %% of a frame\n",
              made.views, made.triangles, made.diagonal, 100 * made.largest_fill);
  std::printf("%.1f %% of the surface is seen by a camera\n", 100 * made.seen);
  print_end(a, made);
}

}  // namespace

void add_synthesize(CLI::App& app) {
  auto a = std::make_shared<SynthesizeArguments>();
  CLI::App* c = add_command(app, "synthesize");
  c->add_option("spec", a->spec, "JSON file that says what is photographed and how");
  c->add_option("--out", a->out, "folder for the scene: new, empty, or an older synthesized scene");
  c->add_option("--views", a->views, "number of views in place of the spec's");
  c->add_option("--size", a->size, "image size in place of the spec's, such as 640x480");
  c->add_option("--seed", a->seed, "seed of everything random in place of the spec's");
  c->add_option("--frames", a->frames,
                "numbers of a sequence's frames, such as 0000-0059: one scene each, in folders of "
                "--out, while the spec's motion passes once");
  add_flags_of(*c, a->device);
  c->add_flag("--list", a->list, "print the built-in shapes with their parameters and stop");
  c->footer(
      "Writes images, masks, depth and normal maps, the exact mesh gt.ply, gt_visible.ply, cameras "
      "in every format and spec.json. The same spec gives the same bytes. Shadows by maps "
      "(light.shadow_test) are drawn on the device.\n\n"
      "Examples:\n"
      "  photohull synthesize datasets/synthetic/block.json --out out/block\n"
      "  photohull synthesize datasets/synthetic/plant.json --out out/plant --size 1280x960\n"
      "  photohull synthesize my_spec.json --out out/mine --views 12 --seed 7\n"
      "  photohull synthesize datasets/synthetic/figure.json --frames 0000-0059 --out out/dance\n"
      "  photohull synthesize --list\n"
      "  photohull reconstruct out/block --out out/block/result");
  c->callback([a] { run_synthesize(*a); });
}

}  // namespace photohull::cli

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "cli/front/command_table.h"
#include "commands.h"
#include "core/error.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "option_flags.h"
#include "pipeline/mask_policy.h"
#include "scene_arguments.h"
#include "terminal_progress.h"
#include "views/prepare_views.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;

struct MasksArguments {
  SceneArguments scene;
  std::optional<std::string> out, compare;
  PrepareOptions prepare;
  bool json = false;
};

/// Intersection over union, and the share of the true object that the mask leaves out.
struct Overlap {
  double iou = 0, missed = 0;
};

Overlap overlap(const Mask& mask, const Mask& truth) {
  double both = 0, either = 0, object = 0;
  for (std::size_t i = 0; i < truth.coverage.size(); ++i) {
    const bool a = !mask.empty() && mask.coverage[i] >= 128, b = truth.coverage[i] >= 128;
    both += a && b, either += a || b, object += b;
  }
  return {either > 0 ? both / either : 1, object > 0 ? 1 - both / object : 0};
}

/// A view's name without its ending: masks of a folder are found by it (docs/guide/masks.md).
std::string stem_of(const PreparedView& view) { return fs::path(view.name).stem().string(); }

/// The file of each view's mask: called as the photograph, or where several photographs would share
/// that name, with their folders and endings before .png.
std::vector<fs::path> mask_files(const fs::path& folder, std::span<const PreparedView> views) {
  std::map<std::string, int> count;
  for (const PreparedView& view : views) ++count[stem_of(view)];
  std::vector<fs::path> files;
  for (const PreparedView& view : views) {
    const bool alone = count[stem_of(view)] == 1;
    const fs::path name = alone ? fs::path(stem_of(view)) : io::name_within(view.name);
    files.push_back(folder / (name.string() + ".png"));
  }
  return files;
}

/// Masks that are known, by the names that masks have.
std::vector<Overlap> compare(const MasksArguments& a, const PreparedViews& prepared) {
  SceneArguments reading = a.scene;
  reading.load.background.clear();
  reading.load.masks = io::MaskSource::kDirectory;
  reading.load.mask_directory = *a.compare;
  const Scene truth = io::load_scene(reading.scene, reading.load);
  std::vector<Overlap> out;
  for (const PreparedView& view : prepared.views) {
    const auto same = std::find_if(truth.views.begin(), truth.views.end(),
                                   [&](const SourceView& v) { return v.name == view.name; });
    PHOTOHULL_CHECK(same != truth.views.end());
    if (same->mask.empty())
      throw Error(concat("--compare ", *a.compare, ": there is no mask for ", view.name,
                         "; give one for every view"));
    const Mask mask = io::read_mask(same->mask);
    if (mask.width != view.image.width || mask.height != view.image.height)
      throw Error(concat("--compare: ", view.name,
                         " was undistorted to another size than its mask; compare views without "
                         "lens distortion"));
    out.push_back(overlap(view.mask, mask));
  }
  return out;
}

/// Masks are called as the photographs, and would take their places.
void check_folder(const std::string& out, const Scene& scene) {
  std::error_code ignored;
  for (const SourceView& view : scene.views)
    if (fs::equivalent(out, view.image.parent_path(), ignored))
      throw UsageError(concat("--out ", out,
                              " is the folder of the scene's photographs; give a folder of its own "
                              "for the masks"));
}

void write_masks(const fs::path& folder, const PreparedViews& prepared) {
  make_folder(folder, "--out");
  const std::vector<fs::path> files = mask_files(folder, prepared.views);
  for (std::size_t i = 0; i < files.size(); ++i) {
    const Mask& mask = prepared.views[i].mask;
    if (mask.empty()) continue;
    make_folder(files[i].parent_path(), "--out");
    io::write_png(files[i], mask.width, mask.height, 1, mask.coverage);
  }
}

void print(const MasksArguments& a, const PreparedViews& prepared,
           const std::vector<Overlap>& known) {
  std::printf("%-24s %-18s %10s %8s%s\n", "view", "mask from", "confidence", "object",
              known.empty() ? "" : "      IoU   missed");
  for (std::size_t i = 0; i < prepared.views.size(); ++i) {
    const PreparedView& view = prepared.views[i];
    double object = 0;
    for (const std::uint8_t c : view.mask.coverage) object += c / 255.0;
    if (!view.mask.empty()) object /= double(view.mask.coverage.size());
    std::printf("%-24s %-18s %10.3f %6.2f %%", view.name.c_str(), prepared.masks[i].source.c_str(),
                prepared.masks[i].confidence, 100 * object);
    if (!known.empty()) std::printf("  %7.4f %6.2f %%", known[i].iou, 100 * known[i].missed);
    std::printf("\n");
  }
  for (const std::string& text : prepared.warnings) std::printf("warning: %s\n", text.c_str());
  if (a.out) std::printf("masks in %s\n", a.out->c_str());
}

void print_json(const PreparedViews& prepared, const std::vector<Overlap>& known) {
  nlohmann::ordered_json j = {{"source", prepared.mask_source},
                              {"confidence", prepared.mask_confidence}};
  j["views"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < prepared.views.size(); ++i) {
    j["views"].push_back({{"name", prepared.views[i].name},
                          {"source", prepared.masks[i].source},
                          {"confidence", prepared.masks[i].confidence}});
    if (!known.empty())
      j["views"].back()["iou"] = known[i].iou, j["views"].back()["missed"] = known[i].missed;
  }
  j["warnings"] = prepared.warnings;
  std::printf("%s\n",
              j.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
}

void run_masks(const MasksArguments& a) {
  if (a.out && a.out->empty()) throw UsageError("--out is empty: give a folder for the masks");
  if (a.compare && a.compare->empty())
    throw UsageError("--compare is empty: give a folder of masks that are known");
  a.scene.check();
  const io::LoadSceneOptions& load = a.scene.load;
  Scene scene = io::load_scene(a.scene.scene, load);
  if (a.out) check_folder(*a.out, scene);
  const ViewLoader loader{[](const fs::path& path) { return io::read_image(path); },
                          [](const fs::path& path) { return io::read_mask(path); }};
  PrepareOptions options = a.prepare;
  options.masks = pipeline::mask_policy(load.masks);
  options.strict = load.strict;
  TerminalProgress progress(1);
  progress.stage("masks", 1);
  PreparedViews prepared = prepare_views(scene, loader, options, progress);
  prepared.warnings.insert(prepared.warnings.begin(), scene.warnings.begin(), scene.warnings.end());
  progress.finish();
  std::vector<Overlap> known;
  if (a.compare) known = compare(a, prepared);
  if (a.out) write_masks(*a.out, prepared);
  if (a.json)
    print_json(prepared, known);
  else
    print(a, prepared, known);
}

}  // namespace

void add_masks(CLI::App& app) {
  auto a = std::make_shared<MasksArguments>();
  CLI::App* c = add_command(app, "masks");
  a->scene.add_to(*c);
  c->add_option("--out", a->out,
                "folder to write the masks to, called as the photographs, to touch them up");
  c->add_option("--compare", a->compare,
                "folder of masks that are known: print how far they agree");
  add_flags_of(*c, a->prepare, {"grabcut"});
  c->add_flag("--json", a->json, "print JSON");
  c->footer(
      "Masks are of the undistorted photographs. Confidence is from 0 to 1; masks that were given "
      "have 1.\n\n"
      "Examples:\n"
      "  photohull masks datasets/templeSparseRing --out out/masks\n"
      "  photohull masks turntable --background empty.png\n"
      "  photohull masks scan --masks background --compare scan/masks");
  c->callback([a] { run_masks(*a); });
}

}  // namespace photohull::cli

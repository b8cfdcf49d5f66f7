#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/front/command_table.h"
#include "commands.h"
#include "core/error.h"
#include "core/option_word.h"
#include "core/read_file.h"
#include "film_pictures.h"
#include "io/board_images.h"
#include "io/image_file.h"
#include "kept_steps.h"
#include "option_flags.h"
#include "pose_photos.h"
#include "reconstruct_scene.h"
#include "scene_arguments.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char *kFrames = "frames", *kPose = "pose", *kModel = "model";  // the steps
constexpr const char* kTextured = "glb";

struct ScanArguments {
  PoseArguments photos;
  pipeline::ReconstructOptions job;
  io::LoadSceneOptions load;
  std::string out;
  bool json = false;

  bool given_masks() const { return load.masks == io::MaskSource::kDirectory; }
  fs::path scene() const { return fs::absolute(out).lexically_normal() / "scene"; }
};

void check(const ScanArguments& a) {
  a.photos.check();
  if (a.out.empty()) throw UsageError("--out is empty: give a folder for the results");
  a.job.validate();
  a.load.validate();
  std::error_code ignored;
  for (const std::string& given : a.photos.given())
    for (const fs::path& folder : {fs::path(a.out), a.scene()})
      if (fs::is_directory(given, ignored) && fs::equivalent(given, folder, ignored))
        throw UsageError(concat("--out ", a.out,
                                " is the folder of the photographs; give a folder of its own for "
                                "the results"));
}

void note(const std::string& text) { std::fprintf(stderr, "note: %s\n", text.c_str()); }

/// Is a result of the step to be taken?
bool is_kept(const ScanArguments& a, const KeptSteps& kept, const std::string& step,
             const std::string& identity, const std::string& what) {
  if (a.job.fresh || !kept.has(step, identity)) return false;
  note(concat(what, " of the run before (--fresh makes all anew)"));
  return true;
}

std::vector<fs::path> frames_of(const ScanArguments& a, KeptSteps& kept) {
  const fs::path folder = a.scene() / "frames";
  StepIdentity identity;
  identity.add_file(a.photos.video);
  io::FrameOptions options = a.photos.frames;
  Described described;
  describe(described, options);
  identity.add_options(described);
  std::error_code ignored;
  if (fs::is_directory(folder, ignored) &&
      is_kept(a, kept, kFrames, identity.digest(), "the frames are those"))
    return io::list_images({folder.string()});
  kept.begin(kFrames);
  const std::vector<fs::path> frames = take_pictures(a.photos.video, folder, options);
  kept.done(kFrames, identity.digest());
  return frames;
}

/// The description of a sheet: as given, or where it lies among the photographs.
fs::path board_of(const PoseArguments& photos) {
  if (!photos.board.empty()) return photos.board;
  std::error_code ignored;
  for (const std::string& given : photos.given()) {
    const fs::path folder =
        fs::is_directory(given, ignored) ? fs::path(given) : fs::path(given).parent_path();
    if (fs::is_regular_file(folder / "board.json", ignored)) return folder / "board.json";
  }
  return {};
}

PoseJob pose_job(const ScanArguments& a, KeptSteps& kept) {
  PoseJob job;
  if (!a.photos.passes.empty()) {
    name_unreadable(a.photos.passes);
    job.passes = passes_of(a.photos.passes);
  } else if (a.photos.video.empty()) {
    name_unreadable(a.photos.images);
    job.images = io::list_images(a.photos.images);
  } else {
    job.images = frames_of(a, kept);
  }
  job.names = names_of(job.images);
  job.out = a.scene();
  job.board = board_of(a.photos);
  job.sheet = a.photos.sheet;
  job.focal = a.photos.focal;
  job.make_masks = a.load.masks == io::MaskSource::kAuto;
  if (job.board.empty() && a.given_masks()) job.masks = a.load.mask_directory;
  job.ordered = a.photos.ordered;
  return job;
}

std::string identity_of(PoseJob job) {
  StepIdentity identity;
  for (const fs::path& image : job.images) identity.add_file(image);
  for (const PassOfPhotos& pass : job.passes) {
    identity.add(concat("pass ", pass.name));
    for (const fs::path& image : pass.images) identity.add_file(image);
  }
  if (!job.masks.empty())
    for (const fs::path& mask : io::list_images({job.masks.string()})) identity.add_file(mask);
  identity.add(job.board.empty() ? concat("colmap ", job.ordered)
                                 : concat("sheet ", job.make_masks));
  if (!job.board.empty()) identity.add_file(job.board);
  Described described;
  describe(described, job.sheet);
  describe(described, job.focal);
  identity.add_options(described);
  return identity.digest();
}

/// Warns where a sheet is to be seen and is not used.
void look_for_tags(const PoseJob& job) {
  constexpr std::size_t kLookedAt = 3;
  const Sheet any = make_sheet({});
  for (std::size_t i = 0; i < job.images.size();
       i += std::max<std::size_t>(1, job.images.size() / kLookedAt)) {
    int tags = 0;
    try {
      const SheetView seen = find_tags(io::read_image(job.images[i]), any, job.names[i]);
      tags = int(seen.tags.size()) + seen.foreign;
    } catch (const MemoryError&) {
      throw;
    } catch (const Error&) {  // the step itself says so
    }
    if (tags < 2) continue;
    std::fprintf(stderr,
                 "warning: %s shows tags of a printed sheet: give the file that photohull board "
                 "wrote beside it with --board, for cameras, scale and masks by the sheet\n",
                 job.names[i].c_str());
    return;
  }
}

/// Says again what the step that is kept warned of.
void repeat_warnings(const fs::path& report) {
  const nlohmann::json all = nlohmann::json::parse(read_whole_file(report), nullptr, false);
  if (!all.is_object() || !all.contains("warnings")) return;
  for (const nlohmann::json& text : all["warnings"])
    if (text.is_string()) std::fprintf(stderr, "warning: %s\n", text.get<std::string>().c_str());
}

void pose(const ScanArguments& a, const PoseJob& job, KeptSteps& kept) {
  const std::string identity = identity_of(job);
  std::error_code ignored;
  const bool there = fs::is_regular_file(job.out / "transforms.json", ignored) &&
                     fs::is_regular_file(job.out / "pose.json", ignored);
  if (there && is_kept(a, kept, kPose, identity, "the cameras are those"))
    return repeat_warnings(job.out / "pose.json");
  kept.begin(kPose);
  if (job.board.empty()) look_for_tags(job);
  pose_photos(job, !a.json);
  kept.done(kPose, identity);
}

void reconstruct(const ScanArguments& a, KeptSteps& kept) {
  const std::string identity = model_identity(a.job, a.load, a.scene(), a.out);
  if (has_results(a.out) && is_kept(a, kept, kModel, identity, "the model is that"))
    return tell_results(a.out, a.json);
  kept.begin(kModel);
  try {
    reconstruct_scene(a.job, a.load, a.scene(), a.out, a.json);
  } catch (const Error& failure) {
    if (failure.kind() == ErrorKind::kDoubted) kept.done(kModel, identity);
    throw;
  }
  kept.done(kModel, identity);
}

void run_scan(ScanArguments& a) {
  if (std::ranges::find(a.job.exports, kTextured) == a.job.exports.end())
    a.job.exports.push_back(kTextured);
  check(a);
  make_folder(a.scene(), "--out");
  KeptSteps kept(a.scene() / ".photohull-scan");
  const PoseJob posed = pose_job(a, kept);
  if (posed.board.empty()) {
    for (const CLI::Option* option : a.photos.of_the_board)
      if (option->count() > 0)
        throw UsageError(concat(option->get_name(),
                                " is for photographs on a printed sheet: give its file with "
                                "--board"));
  } else {
    refuse_given(a.photos.of_colmap, "a printed sheet (" + posed.board.string() + ")");
    if (!posed.make_masks && !posed.passes.empty())
      throw UsageError(
          concat(option_word("masks"),
                 " does not go together with --pass: passes are joined, and the object "
                 "told from the sheet, by masks that are made from the sheet's picture"));
    if (!a.job.mesh_files.unit) a.job.mesh_files.unit = LengthUnit::kMillimetre;
  }
  pose(a, posed, kept);
  reconstruct(a, kept);
}

/// All of reconstruct's but those that say where a scene's files are.
void add_job(CLI::App& command, ScanArguments& a) {
  constexpr const char* kOfScenes[] = {"format", "images", "pixel_center"};
  Described described;
  describe(described, a.job, a.load);
  std::vector<std::string> names;
  for (const Option& option : described.options())
    if (std::ranges::find(kOfScenes, option.name) == std::end(kOfScenes))
      names.push_back(option.name);
  add_flags(command, described, names);
}

}  // namespace

void add_scan(CLI::App& app) {
  auto a = std::make_shared<ScanArguments>();
  CLI::App* c = add_command(app, "scan");
  a->photos.add_to(*c, {"unit"});  // millimetres; --unit is that of files
  c->add_option("--out", a->out, "folder for the results; the posed scene goes into scene/ there")
      ->required();
  add_job(*c, *a);
  c->add_flag("--json", a->json, "print report.json on standard output instead of summaries");
  c->footer(
      "Finds the cameras as 'photohull pose' does, on a printed sheet where --board gives one or "
      "board.json lies among the photographs, else by COLMAP; then masks, box, model and texture "
      "as 'photohull reconstruct' does. Run again with the same photographs, it goes on from the "
      "steps that are done.\n\n"
      "Examples:\n"
      "  photohull scan photos/ --out model\n"
      "  photohull scan photos/ --board board.json --bar 149.5 --out model\n"
      "  photohull scan --pass side1/ side2/ --board board.json --out model\n"
      "  photohull scan --video film.mp4 --frames 80 --out model\n"
      "  photohull scan photos/ --out model --masks my_masks --quality high");
  c->callback([a] { run_scan(*a); });
}

}  // namespace photohull::cli

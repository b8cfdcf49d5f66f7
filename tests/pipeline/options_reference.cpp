#include "options_reference.h"

#include <algorithm>
#include <sstream>
#include <vector>

#include "calib/calibrate_board.h"
#include "calib/pose_photographs.h"
#include "calib/turntable_angles.h"
#include "cameras/refine_cameras.h"
#include "cli/front/flag_words.h"
#include "core/error.h"
#include "eval/evaluate.h"
#include "eval/photo_agreement.h"
#include "gpu/device_options.h"
#include "io/film_frames.h"
#include "io/photo_lens.h"
#include "lab/chart/chart_job.h"
#include "lab/chart/stress_job.h"
#include "lab/sampling/sampling_study.h"
#include "lab/visibility/study.h"
#include "pipeline/tuning.h"
#include "render/turntable.h"
#include "sheet/sheet.h"
#include "views/prepare_views.h"

namespace photohull::pipeline {
namespace {

std::string code(const std::string& text) { return text.empty() ? "" : "`" + text + "`"; }

std::string legal_of(const Option& option) {
  if (std::holds_alternative<bool*>(option.place)) return "";
  const std::string legal = legal_values(option);
  return option.unit.empty() || !option.expects.empty() ? legal : legal + " " + option.unit;
}

std::string default_of(const Option& option) {
  if (!std::holds_alternative<bool*>(option.place)) return text_of(option);
  return text_of(option).empty() ? "off" : "on";
}

void write_table(const Described& described, bool flags, std::ostream& out) {
  out << (flags ? "| option | default | values | changes from | what it says |\n"
                : "| parameter | default | values | changes from | what it is |\n")
      << "|---|---|---|---|---|\n";
  for (const Option& option : described.options())
    if (flags || option_that_sets(option.name).empty())
      out << "| " << code(flags ? cli::flag_of(option.name) : option.name) << " | "
          << code(default_of(option)) << " | " << legal_of(option) << " | "
          << to_string(option.from) << " | " << option.help << " |\n";
}

/// Options of a command that the main job's stages do not follow from: those of a struct that have
/// flags, or all of it.
template <typename Options>
void write_command(const std::string& title, const std::vector<std::string>& names,
                   std::ostream& out) {
  Options options;
  Described described;
  describe(described, options);
  out << "\n### " << title
      << "\n\n| option | default | values | what it says |\n|---|---|---|---|\n";
  for (const Option& option : described.options())
    if (names.empty() || std::ranges::find(names, option.name) != names.end())
      out << "| " << code(cli::flag_of(option.name)) << " | " << code(default_of(option)) << " | "
          << legal_of(option) << " | " << option.help << " |\n";
}

void write_commands(std::ostream& out) {
  out << "\n## Other commands\n\n"
         "What else these commands take, such as files, is told by `photohull COMMAND --help`. "
         "Those "
         "that read a scene have the\noptions above that say how it is read.\n";
  write_command<eval::EvaluateOptions>(
      "`photohull evaluate`", {"thresholds", "absolute", "samples", "seed", "min_views"}, out);
  write_command<eval::PhotoOptions>("`photohull evaluate`: photographs that were held out",
                                    {"least_angle", "window"}, out);
  write_command<PrepareOptions>("`photohull masks`", {"grabcut"}, out);
  write_command<RefineCamerasOptions>("`photohull refine-cameras`", {}, out);
  write_command<SheetOptions>("`photohull board`", {}, out);
  write_command<PoseOptions>("`photohull pose`", {}, out);
  write_command<render::TurntableOptions>("`photohull render`", {}, out);
  write_command<BoardSpec>("`photohull calibrate`: the board", {}, out);
  write_command<CalibrateOptions>("`photohull calibrate`: the camera", {}, out);
  write_command<PoseOptions>("`photohull pose` and `scan`: the printed sheet", {}, out);
  write_command<io::FrameOptions>("`photohull pose` and `scan`: films", {}, out);
  write_command<io::FocalOptions>("`photohull pose` and `scan`: the lens", {}, out);
  write_command<TurntableAngles>("`photohull calibrate` and `convert`: turntables", {}, out);
  write_command<gpu::DeviceOptions>(
      "`photohull synthesize`, `bench sampling` and `bench visibility`: the device", {}, out);
  write_command<chart::ChartOptions>("`photohull chart`", {}, out);
  write_command<chart::StressOptions>("`photohull stress`", {}, out);
  write_command<projtex::StudyOptions>("`photohull bench sampling`", {}, out);
  write_command<visibility::StudyOptions>("`photohull bench visibility`",
                                          {"scenes", "resolutions", "techniques", "repeats"}, out);
}

/// A stage's own parameters, and `group` before their names.
template <typename Options>
void write_parameters(const std::string& title, const std::string& group, std::ostream& out) {
  Options options;
  Described described;
  if (group.empty())
    describe(described, options);
  else
    described.group(group, options);
  out << "\n### " << title << "\n\n";
  write_table(described, false, out);
}

}  // namespace

std::string options_reference() {
  const OptionWording before = set_option_wording(cli::flag_wording());
  std::ostringstream out;
  out << "# Options\n\n"
         "Written by `build/release/tests/pipeline/write_options_reference > "
         "docs/reference/options.md` from what describes the\noptions in the program; a test "
         "compares the two.\n\n"
         "## `photohull reconstruct`\n\n"
         "*Changes from* is the first of the stages views, hull, surface, mesh and files whose "
         "result an option changes; all\nlater ones follow from it. An interrupted refinement goes "
         "on where it was (`--fresh` does not) when no option that\nchanges the surface or an "
         "earlier stage was changed.\n\n";
  ReconstructOptions options;
  Described described;
  io::LoadSceneOptions load;
  describe(described, options, load);
  write_table(described, true, out);
  out << "\n## Parameters\n\n"
         "For experiments: `--tune NAME=VALUE` changes one, with 0 and 1 for off and on. A method "
         "has those of its own and those\nof the stages that methods share. The\nunit of lengths "
         "of sharp edges is what the surface resolves: a voxel, or 1.5 "
         "pixels "
         "where these are larger.\n";
  write_parameters<carving::MissingOptions>("What masks show and the hull lacks (all methods)",
                                            "missing", out);
  write_parameters<carving::StemOptions>("Stems (all methods)", "stems", out);
  write_parameters<refine::RefineOptions>("Refinement (`--method refine`)", "", out);
  write_parameters<SharpenOptions>("Sharp edges (`--method refine`)", "sharpen", out);
  write_parameters<carving::PhotoOptions>(
      "Plane sweeps (`--method space-carving` and `voxel-coloring`)", "", out);
  write_commands(out);
  set_option_wording(before);
  return out.str();
}

}  // namespace photohull::pipeline

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>

#include "calib/calibrate_rig.h"
#include "calib/judge_calibration.h"
#include "calib/turntable_angles.h"
#include "calibration_json.h"
#include "cli/front/command_table.h"
#include "commands.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "io/board_images.h"
#include "io/image_file.h"
#include "io/read_lens.h"
#include "option_flags.h"
#include "other_board.h"
#include "photo/for_photographs.h"
#include "terminal_progress.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;

struct CalibrateArguments {
  std::vector<std::string> images;
  std::string out, coverage;
  std::optional<std::string> rig, lens_from;
  TurntableAngles angles;
  BoardSpec spec;
  CalibrateOptions options;
  bool json = false;
};

/// Looks for the board in pictures, with progress. A path that is empty gives no view.
std::vector<BoardView> find_boards(const BoardSpec& spec, const std::vector<fs::path>& images,
                                   const std::vector<std::string>& names) {
  TerminalProgress progress(1);
  progress.stage("boards", 1);
  std::vector<BoardView> views(images.size());
  const auto find = [&](std::size_t i) {
    progress.check_cancelled();
    if (!images[i].empty()) views[i] = find_board(io::read_image(images[i]), spec, names[i]);
  };
  for_photographs(images.size(), io::pixels_of_largest(images), find,
                  [&](std::size_t done) { progress.update(double(done) / double(images.size())); });
  progress.finish();
  return views;
}

/// Degrees of each picture; none where they are to be found.
std::vector<double> angles_of(const CalibrateArguments& a, std::size_t pictures) {
  if (a.angles.given() && !a.options.turntable)
    throw UsageError("--step and --angles are for --turntable");
  return a.angles.of(pictures);
}

void write_result(const CalibrateArguments& a, const std::string& text) {
  write_atomically(a.out, text);
  if (a.json) std::fputs(text.c_str(), stdout);
}

/// The lens of --lens-from for these pictures, of the rig's camera named so; nothing where the lens
/// is to be found, or where no picture shows the board, which is said elsewhere.
std::optional<KnownLens> known_lens(const CalibrateArguments& a,
                                    const std::vector<BoardView>& views,
                                    const std::string& camera = {}) {
  if (!a.lens_from) return std::nullopt;
  for (const BoardView& view : views) {
    if (view.points.empty()) continue;
    const io::CameraLens lens = io::read_lens(*a.lens_from, view.width, view.height, camera);
    return KnownLens{lens.intrinsics, lens.distortion};
  }
  return std::nullopt;
}

/// Runs `calibrate`, and where that fails says whether another board would not.
template <typename Calibrate>
auto with_hint(const CalibrateArguments& a, const std::vector<fs::path>& images, LensModel lens,
               const Calibrate& calibrate) {
  try {
    return calibrate();
  } catch (const UsageError&) {
    throw;
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& failure) {
    const std::string hint = suggest_board(images, a.spec, lens, INFINITY);
    if (hint.empty()) throw;
    throw Error(concat(failure.what(), "; ", hint));
  }
}

/// Throws Error for what must not be used, before anything is written; else returns the doubts,
/// told.
std::vector<std::string> check(const CalibrateArguments& a, const std::vector<fs::path>& images,
                               LensModel lens, double rms, const CalibrationJudgement& judged) {
  const std::string hint = judged.misfits ? suggest_board(images, a.spec, lens, rms) : "";
  if (!judged.refusal.empty())
    throw Error(concat(judged.refusal, hint.empty() ? "" : "; ", hint, "; nothing was written"));
  std::vector<std::string> doubts = judged.doubts;
  if (!hint.empty()) doubts.push_back(hint);
  for (const std::string& text : doubts) std::fprintf(stderr, "warning: %s\n", text.c_str());
  return doubts;
}

void run_rig(const CalibrateArguments& a) {
  const LensModel lens = a.options.lens;
  if (a.options.turntable) throw UsageError("--rig and --turntable: calibrate one at a time");
  if (!a.coverage.empty()) throw UsageError("--coverage is for one camera, not for --rig");
  if (a.images.size() != 1)
    throw UsageError("--rig: give one folder, in which the pictures are found by their names");
  const io::RigImages images = io::list_rig_images(a.images[0], *a.rig);
  std::vector<fs::path> pictures;
  std::vector<std::string> names;
  for (const std::vector<fs::path>& of_camera : images.images)
    for (const fs::path& image : of_camera) {
      pictures.push_back(image);
      names.push_back(image.lexically_relative(a.images[0]).string());
    }
  std::vector<BoardView> boards = find_boards(a.spec, pictures, names);
  std::vector<RigCameraViews> views;
  std::size_t next = 0;
  for (std::size_t c = 0; c < images.cameras.size(); ++c) {
    views.push_back({images.cameras[c], {}});
    for (std::size_t i = 0; i < images.images[c].size(); ++i)
      views[c].views.push_back(std::move(boards[next++]));
  }
  std::vector<fs::path> all;
  for (std::size_t c = 0; c < views.size(); ++c) {
    views[c].known = known_lens(a, views[c].views, views[c].name);
    std::copy_if(images.images[c].begin(), images.images[c].end(), std::back_inserter(all),
                 [](const fs::path& image) { return !image.empty(); });
  }
  const RigCalibration rig = with_hint(a, all, lens, [&] { return calibrate_rig(views, lens); });
  if (!a.json) print_rig(views, rig);
  const auto doubts = check(a, all, lens, rig.all_rms, judge_calibration(rig));
  write_result(a, rig_json(views, images.moments, rig, doubts));
}

void run_camera(const CalibrateArguments& a) {
  const std::vector<fs::path> images = io::list_images(a.images);
  CalibrateOptions options = a.options;
  const LensModel lens = options.lens;
  options.angles = angles_of(a, images.size());
  options.validate(images.size());
  std::vector<std::string> names;
  for (const fs::path& image : images) names.push_back(image.filename().string());
  const std::vector<BoardView> views = find_boards(a.spec, images, names);
  options.known = known_lens(a, views);
  const Calibration calibration =
      with_hint(a, images, lens, [&] { return calibrate(views, options); });
  if (!a.json) print_calibration(views, calibration);
  const auto doubts =
      check(a, images, lens, calibration.all_rms, judge_calibration(views, calibration));
  write_result(a, calibration_json(views, calibration, doubts));
  if (!a.coverage.empty()) {
    const ColourImage picture = coverage_picture(views, calibration);
    io::write_png(a.coverage, picture.width, picture.height, 4, picture.bytes);
  }
}

void run_calibrate(const CalibrateArguments& a) {
  a.spec.validate();
  if (a.out.empty()) throw UsageError("--out is empty: give the JSON file for the calibration");
  if ((a.rig || a.options.turntable) && a.spec.looks_same_turned())
    throw UsageError(
        "this board looks the same after half a turn, so that its corners cannot be told apart "
        "between pictures: for --rig and --turntable use charuco, or a chessboard with an odd "
        "number of inner corners one way and an even one the other");
  if (a.rig)
    run_rig(a);
  else
    run_camera(a);
}

}  // namespace

void add_calibrate(CLI::App& app) {
  auto a = std::make_shared<CalibrateArguments>();
  CLI::App* c = add_command(app, "calibrate");
  c->add_option("images", a->images, "photographs, or folders of them")->required();
  c->add_option("--out", a->out, "JSON file for the calibration")->required();
  add_flags_of(*c, a->spec);
  CLI::Option* lens = add_flags_of(*c, a->options, {"lens"}).front();
  c->add_option("--lens-from", a->lens_from,
                "the lens is known, and poses alone are found: a file of photohull calibrate, or a "
                "scene of one lens in any format")
      ->excludes(lens);
  add_flags_of(*c, a->options, {"turntable"});
  add_flags_of(*c, a->angles);
  c->add_option("--rig", a->rig,
                "several cameras that see the board at the same moments: how their pictures are "
                "called below the folder given, such as \"{camera}/{moment}\"");
  c->add_option("--coverage", a->coverage, "PNG of where in the frame the board was seen");
  c->add_flag("--json", a->json, "print the calibration instead of a summary");
  c->footer(
      "Views whose error is far from the others' are named and left out. What cannot be a camera, "
      "or "
      "is too uncertain to reconstruct with, is refused with exit code 1 and no file; what is "
      "doubtful is warned of. The file serves "
      "'photohull convert CALIB --images PHOTOGRAPHS', which makes a scene of photographs that the "
      "same cameras took.\n\n"
      "Examples:\n"
      "  photohull calibrate boards/ --columns 9 --rows 6 --square 0.025 --out calib.json\n"
      "  photohull calibrate rig/ --rig \"{camera}/{moment}\" --square 0.025 --out rig.json\n"
      "  photohull calibrate table/ --board charuco --columns 8 --rows 6 --turntable --step 10 "
      "--lens-from calib.json --out t.json");
  c->callback([a] { run_calibrate(*a); });
}

}  // namespace photohull::cli

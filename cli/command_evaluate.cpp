#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/front/command_table.h"
#include "commands.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "eval/agreement_json.h"
#include "eval/error_image.h"
#include "eval/error_mesh.h"
#include "eval/evaluate.h"
#include "eval/evaluation_json.h"
#include "eval/reliability.h"
#include "evaluate_photos.h"
#include "io/image_file.h"
#include "io/mesh/read_mesh.h"
#include "option_flags.h"
#include "terminal_progress.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kAlignWeight = 6;       // of the progress
constexpr double kPoorAlignment = 0.02;  // of the truth's diagonal

struct EvaluateArguments {
  std::string mesh, error_mesh, error_image, reliability_plot;
  std::optional<std::string> truth;
  PhotoArguments photos;
  double error_range = 0.005;
  std::optional<double> reliability;  ///< world units
  eval::EvaluateOptions options;
  bool json = false, align = false;
  DrawReliability draw = nullptr;
};

void print_scores(const std::vector<eval::Score>& all, const std::vector<eval::Score>& seen) {
  for (std::size_t i = 0; i < all.size(); ++i)
    std::printf("%9.4g %%  %-10.4g %9.2f %9.2f %9.2f %9.2f %9.2f\n", 100 * seen[i].threshold,
                seen[i].distance, 100 * seen[i].precision, 100 * seen[i].recall, 100 * seen[i].f,
                100 * all[i].precision, 100 * all[i].f);
}

std::string shown(const std::optional<double>& value) {
  if (!value) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.4f", *value);
  return text;
}

void print_reliability(const eval::Reliability& r) {
  std::printf(
      "\nconfidence  as the chance to lie within %.5g: %zu vertices, %.2f %% within, and %zu that "
      "no "
      "camera saw\n",
      r.distance, r.seen, 100 * r.within, r.unseen);
  std::printf("%-12s %9s %12s %9s\n", "bin", "vertices", "confidence", "within");
  for (const eval::ReliabilityBin& b : r.bins)
    if (b.count > 0)
      std::printf("%.1f to %-5.1f %9zu %12.4f %9.4f\n", b.low, b.high, b.count, b.confidence,
                  b.within);
  std::printf("calibration error %.4f, Brier score %.4f, AUC %s, Spearman %s\n",
              r.calibration_error, r.brier, shown(r.auc).c_str(), shown(r.spearman).c_str());
}

void print_alignment(const eval::Alignment& a, double diagonal) {
  std::printf(
      "aligned     scaled by %.6g, turned by %.4g degrees, then moved by %g %g %g; %.4g %% of the "
      "diagonal rms is left\n",
      a.scale, a.degrees, a.translation.x, a.translation.y, a.translation.z,
      100 * a.rms / diagonal);
}

void print_text(const eval::Evaluation& e) {
  const double d = e.truth_diagonal;
  const auto row = [d](const char* name, double seen, double all) {
    std::printf("%-24s %11.5g %8.4f %% %11.5g %8.4f %%\n", name, seen, 100 * seen / d, all,
                100 * all / d);
  };
  const auto one = [d](const char* name, double value) {
    std::printf("%-24s %11.5g %8.4f %%\n", name, value, 100 * value / d);
  };
  std::printf("result      %s: %zu vertices, %zu faces%s\n", e.result_name.c_str(), e.vertices,
              e.faces, e.points ? ", judged as points" : "");
  if (e.truth_is_points)
    std::printf("truth       %s: points, diagonal %g\n", e.truth_name.c_str(), d);
  else
    std::printf("truth       %s: %zu faces, diagonal %g\n", e.truth_name.c_str(), e.truth_faces, d);
  if (e.alignment) print_alignment(*e.alignment, d);
  std::printf("counted     %s\n", e.truth_note.c_str());
  std::printf(
      "samples     %zu of the result, %.2f %% over seen surface; %zu of %zu of the truth\n\n",
      e.result_samples, 100 * e.seen.share, e.truth_samples_seen, e.truth_samples);
  std::printf("%-24s %22s %22s\n", "distance (of diagonal)", "over seen surface", "whole result");
  const std::string accuracy = concat("accuracy (", 100 * eval::kAccuracyShare, " %)");
  row(accuracy.c_str(), e.seen.accuracy, e.all.accuracy);
  row("result to truth, mean", e.seen.to_truth.mean, e.all.to_truth.mean);
  row("                 median", e.seen.to_truth.median, e.all.to_truth.median);
  row("                 RMS", e.seen.to_truth.rms, e.all.to_truth.rms);
  if (e.all.mean_signed)
    row("                 signed", e.seen.mean_signed.value(), *e.all.mean_signed);
  one("truth to result, mean", e.to_result.mean);
  one("                 median", e.to_result.median);
  one("                 RMS", e.to_result.rms);
  one("Hausdorff 95 %", e.hausdorff95);
  one("chamfer", e.chamfer);
  std::printf("%-24s %11.2f %% of the truth within %g %% of the diagonal\n\n", "completeness",
              100 * e.completeness, 100 * eval::kCompletenessThreshold);
  std::printf("%-12s %-10s %9s %9s %9s %9s %9s\n", "threshold", "distance", "precision", "recall",
              "F", "precision", "F, whole");
  print_scores(e.all.scores, e.seen.scores);
  print_scores(e.all.absolute, e.seen.absolute);
  if (e.seen.normals)
    std::printf("\nnormals     %.2f degrees off in the mean, %.2f %% within 10 degrees\n",
                e.seen.normals->mean, 100 * e.seen.normals->within_10);
  if (e.volume.known)
    std::printf("volume      IoU %.4f: %g of the result, %g of the truth, %g of both\n",
                e.volume.iou, e.volume.first, e.volume.second, e.volume.intersection);
  else
    std::printf("volume      IoU not known: %s\n", e.volume.reason.c_str());
  if (e.reliability) print_reliability(*e.reliability);
  for (const std::string& text : e.warnings) std::printf("warning: %s\n", text.c_str());
}

/// The files asked for, opened before the work so that a bad path is told at once.
struct Outputs {
  explicit Outputs(const EvaluateArguments& a) {
    if (!a.error_mesh.empty()) mesh.emplace(a.error_mesh);
    if (!a.error_image.empty()) image.emplace(a.error_image);
    if (!a.reliability_plot.empty()) plot.emplace(a.reliability_plot);
    if (!a.photos.picture.empty()) photos.emplace(a.photos.picture);
  }
  std::optional<AtomicFile> mesh, image, plot, photos;
};

void write_image(AtomicFile& file, const EvaluateArguments& a, const TriMesh& result,
                 const eval::Truth& truth, const eval::Evaluation& e, Progress& progress) {
  const eval::Score& score = e.seen.scores.back();
  const std::string title =
      concat(fs::path(a.mesh).filename().string(), ": F ", std::round(10000 * score.f) / 100,
             " % within ", 100 * score.threshold, " % of the diagonal");
  const RgbImage image = eval::draw_error_image(
      result, truth, {a.error_range * truth.diagonal(), 480, title}, progress);
  io::write_png(file, image);
}

bool ends_with(const std::string& path, const char* extension) {
  return fs::path(path).extension() == extension;
}

void write_plot(AtomicFile& file, const EvaluateArguments& a, const eval::Reliability& r) {
  const std::string bytes =
      a.draw(fs::path(a.mesh).stem().string(), r, ends_with(a.reliability_plot, ".svg"));
  file.write(bytes.data(), bytes.size());
}

void check(const EvaluateArguments& a) {
  if (!a.truth && !a.photos.given())
    throw UsageError(
        "nothing to judge by: give --truth, or --photos with --views (held-out photographs), or "
        "both");
  a.photos.check();
  a.options.validate();
  if (a.reliability && !(*a.reliability > 0 && std::isfinite(*a.reliability)))
    throw UsageError(concat("--reliability (world units) must be above 0, not ", *a.reliability));
  if (a.reliability_plot.empty()) return;
  if (!a.reliability) throw UsageError("--reliability-plot needs --reliability DISTANCE");
  if (!ends_with(a.reliability_plot, ".svg") && !ends_with(a.reliability_plot, ".png"))
    throw UsageError(concat("--reliability-plot ", a.reliability_plot,
                            ": expected a name that ends in .svg or .png"));
  if (!a.draw)
    throw UsageError(concat("--reliability-plot is drawn by ", kLabProgram,
                            ", which photohull starts where it is asked for"));
}

eval::Evaluation evaluate_by_truth(const EvaluateArguments& a, const TriMesh& given,
                                   Outputs& outputs, Progress& progress) {
  const eval::Truth truth = eval::read_truth(*a.truth);
  if (given.triangles.empty() && outputs.image)
    throw Error(concat(a.mesh, " has no faces; --error-image needs some"));
  if (truth.is_points() && (outputs.image || outputs.mesh))
    throw Error(concat(*a.truth, " has no faces; --error-image and --error-mesh need some"));
  std::optional<eval::Alignment> alignment;
  if (a.align) {
    progress.stage("alignment", kAlignWeight);
    alignment = eval::align(given, truth, a.options.seed, progress);
  }
  const TriMesh result = alignment ? eval::moved(given, *alignment) : given;
  eval::Evaluation e = eval::evaluate(result, truth, a.options, &progress);
  e.result_name = a.mesh;
  e.alignment = alignment;
  if (alignment && alignment->rms > kPoorAlignment * truth.diagonal())
    e.warnings.push_back(concat("the alignment leaves ",
                                std::round(1000 * alignment->rms / truth.diagonal()) / 10,
                                " % of the diagonal: these may not be of the same object"));
  if (a.reliability) {
    progress.stage("reliability", 1);
    e.reliability = eval::measure_reliability(result, truth, *a.reliability, progress);
    if (outputs.plot) write_plot(*outputs.plot, a, *e.reliability);
  }
  if (outputs.mesh) {
    progress.stage("error mesh", 1);
    eval::write_error_mesh(*outputs.mesh, result, truth.surface(), a.error_range * truth.diagonal(),
                           progress);
  }
  if (outputs.image) {
    progress.stage("error picture", 1);
    write_image(*outputs.image, a, result, truth, e, progress);
  }
  return e;
}

void run_evaluate(const EvaluateArguments& a) {
  check(a);
  if (!(a.error_range > 0 && a.error_range <= 1))
    throw UsageError(concat("--error-range must be above 0 and at most 1, not ", a.error_range));
  Outputs outputs(a);
  TerminalProgress progress((a.truth ? 12 : 0) + (a.align ? kAlignWeight : 0) +
                            (a.photos.given() ? kPhotoWeight : 0));
  const TriMesh result = read_mesh(a.mesh, Faces::kOptional);
  std::optional<eval::Evaluation> evaluation;
  std::optional<eval::PhotoAgreement> photos;
  if (a.photos.given())
    photos = judge_photos(a.photos, result, a.mesh, outputs.photos ? &*outputs.photos : nullptr,
                          progress);
  if (a.truth) evaluation = evaluate_by_truth(a, result, outputs, progress);
  for (std::optional<AtomicFile>* file :
       {&outputs.mesh, &outputs.image, &outputs.plot, &outputs.photos})
    if (*file) (*file)->commit();
  progress.finish();
  if (a.json) {
    const std::string first = evaluation ? eval::to_json(*evaluation) : std::string();
    std::printf("%s\n", photos ? eval::to_json(*photos, first).c_str() : first.c_str());
    return;
  }
  if (evaluation) print_text(*evaluation);
  if (evaluation && photos) std::printf("\n");
  if (photos) print_agreement(*photos);
}

}  // namespace

void add_evaluate(CLI::App& app, DrawReliability draw) {
  auto a = std::make_shared<EvaluateArguments>();
  a->draw = draw;
  CLI::App* c = add_command(app, "evaluate");
  c->add_option("mesh", a->mesh, "the result: PLY, OBJ, OFF, STL or glTF; points without faces too")
      ->required();
  CLI::Option* truth =
      c->add_option("--truth", a->truth,
                    "a scene folder with gt.ply and gt_visible.ply, or a mesh or points all of "
                    "which count");
  c->add_flag("--align", a->align,
              "first move, turn and scale the result onto the truth, and say how");
  add_flags_of(*c, a->options, {"thresholds", "absolute", "samples", "seed", "min_views"});
  c->add_option("--error-mesh", a->error_mesh,
                "write the result as a PLY coloured by its signed distance");
  c->add_option("--error-image", a->error_image, "write a PNG of that from six sides");
  c->add_option("--error-range", a->error_range,
                "distance of the strongest colours, a fraction of the diagonal")
      ->capture_default_str();
  c->add_option("--reliability", a->reliability,
                "does confidence mean the chance to lie within this distance (world units)?");
  c->add_option("--reliability-plot", a->reliability_plot, "draw that as an SVG or PNG");
  for (const char* name :
       {"--thresholds", "--absolute", "--samples", "--seed", "--min-views", "--error-mesh",
        "--error-image", "--error-range", "--reliability", "--align"})
    c->get_option(name)->needs(truth);
  a->photos.add_to(*c);
  c->add_flag("--json", a->json, "print JSON (docs/guide/evaluate.md)");
  c->footer(
      "Examples:\n"
      "  photohull evaluate out/bunny/mesh.ply --truth scenes/bunny\n"
      "  photohull evaluate scan.obj --truth cad.stl --absolute 0.1,0.5 --json\n"
      "  photohull evaluate mesh.ply --truth scenes/bunny --error-image errors.png\n"
      "  photohull evaluate scan.ply --truth laser.ply --align\n"
      "  photohull evaluate out/mesh.ply --truth scenes/bunny --reliability 0.004 "
      "--reliability-plot r.svg\n"
      "  photohull evaluate out/temple/mesh.ply --photos scenes/temple --views 0,8,16 --picture "
      "worst.png");
  c->callback([a] { run_evaluate(*a); });
}

}  // namespace photohull::cli

#include <array>
#include <cstdio>
#include <memory>
#include <optional>

#include "cli/front/command_table.h"
#include "cli/front/parse_faults.h"
#include "commands.h"
#include "core/error.h"
#include "core/parse_name.h"
#include "pipeline/image_scale.h"
#include "pipeline/memory.h"
#include "pipeline/reconstruct.h"
#include "scene_arguments.h"
#include "terminal_progress.h"

namespace photohull::cli {
namespace {

struct Arguments {
  SceneArguments scene;
  std::string out, quality = "normal", device = "auto", mesh_error = "0", unseen = "auto",
                   surroundings = "off", mask_offset = "auto", mask_holes = "mend",
                   views_may_miss = "auto", photometric = "auto", lattice = "fit",
                   image_scale = "auto", max_memory = "auto";
  std::optional<std::string> method, refine_cameras, sampler, consistency, visibility;
  std::optional<int> resolution, supersample;
  std::optional<double> voxel_size, r_consistency, noise;
  std::vector<std::string> tune;
  int threads = 0;
  bool box_exact = false, keep_views = false, evidence = false, fresh = false, json = false;
};

pipeline::ReconstructOptions to_options(const Arguments& a) {
  using pipeline::Method;
  using pipeline::Quality;
  pipeline::ReconstructOptions o;
  o.scene = a.scene.scene;
  o.output = a.out;
  o.load = a.scene.options();
  o.load.most_views = io::kEnoughViews;
  o.box = a.scene.box_options();
  o.box.exact = a.box_exact;
  o.lattice = parse_name("--lattice", a.lattice,
                         std::array{pipeline::Lattice::kFit, pipeline::Lattice::kFixed});
  o.quality = parse_name("--quality", a.quality,
                         std::array{Quality::kDraft, Quality::kNormal, Quality::kHigh});
  if (a.method)
    o.method = parse_name(
        "--method", *a.method,
        std::array{Method::kHull, Method::kVoxelColoring, Method::kSpaceCarving, Method::kRefine});
  if (a.sampler) o.sampler = parse_name("--sampler", *a.sampler, projtex::kSamplers);
  if (a.consistency)
    o.consistency = parse_name("--consistency", *a.consistency, carving::kStatistics);
  if (a.visibility)
    o.visibility = parse_name("--visibility", *a.visibility, visibility::kSweepTests);
  o.r_consistency = a.r_consistency;
  o.supersample = a.supersample;
  o.resolution = a.resolution;
  o.voxel_size = a.voxel_size;
  o.mesh_error = pipeline::parse_mesh_error(a.mesh_error);
  o.unseen = parse_name(
      "--unseen", a.unseen,
      std::array{pipeline::Unseen::kAuto, pipeline::Unseen::kOpen, pipeline::Unseen::kClosed});
  using pipeline::Surroundings;
  o.surroundings =
      parse_name("--surroundings", a.surroundings,
                 std::array{Surroundings::kAuto, Surroundings::kOn, Surroundings::kOff});
  using pipeline::RefineCameras;
  if (a.refine_cameras)
    o.refine_cameras =
        parse_name("--refine-cameras", *a.refine_cameras,
                   std::array{RefineCameras::kOff, RefineCameras::kAuto, RefineCameras::kPoses,
                              RefineCameras::kPosesAndIntrinsics});
  using pipeline::Photometric;
  o.photometric = parse_name("--photometric", a.photometric,
                             std::array{Photometric::kOff, Photometric::kAuto, Photometric::kOn});
  o.mask_offset = pipeline::parse_mask_offset(a.mask_offset);
  if (a.mask_holes != "mend" && a.mask_holes != "keep")
    throw UsageError(concat("--mask-holes ", a.mask_holes, ": expected mend or keep"));
  o.keep_mask_holes = a.mask_holes == "keep";
  o.views_may_miss = pipeline::parse_views_may_miss(a.views_may_miss);
  o.noise = a.noise;
  o.keep_views = a.keep_views;
  o.image_scale = pipeline::parse_image_scale(a.image_scale);
  o.max_memory = pipeline::parse_max_memory(a.max_memory);
  o.device = a.device;
  o.threads = a.threads;
  o.evidence = a.evidence;
  o.fresh = a.fresh;
  o.tune = a.tune;
  o.validate();
  return o;
}

void print_summary(const pipeline::Report& report, const std::string& out) {
  const glm::ivec3 n = report.grid.voxels();
  std::printf("%d views, %d x %d x %d voxels of %g, %lld triangles\n", report.views, n.x, n.y, n.z,
              report.grid.voxel_size, static_cast<long long>(report.triangles));
  if (report.smallest_scale < 1)
    std::printf("photographs read at %s of their size\n",
                pipeline::image_scale_text(report.smallest_scale).c_str());
  if (report.voxels_judged)
    std::printf("judged %lld voxels in %d sweeps, carved %lld\n",
                static_cast<long long>(report.voxels_judged), report.sweeps,
                static_cast<long long>(report.voxels_carved));
  if (!report.photometric_line.empty()) std::printf("%s\n", report.photometric_line.c_str());
  std::printf("%.2f s (%.2f CPU s), peak memory %lld MiB, on %s\n", report.wall_seconds,
              report.cpu_seconds, static_cast<long long>(report.peak_memory_bytes >> 20),
              report.device.c_str());
  for (const std::string& file : report.files) std::printf("  %s/%s\n", out.c_str(), file.c_str());
  std::printf("verdict: %s\n", assess::to_string(report.verdict.level));
  for (const std::string& reason : report.verdict.reasons) std::printf("  %s\n", reason.c_str());
  for (const std::string& note : report.verdict.notes) std::printf("  %s\n", note.c_str());
  std::printf("coverage: %s\n", report.verdict.coverage.c_str());
}

/// The files are there all the same, to look at.
void throw_if_failed(const assess::Verdict& verdict) {
  if (verdict.level != assess::Level::kFailed) return;
  throw Error("the result failed its own checks: " + verdict.reasons.front(),
              assess::kFailedVerdict);
}

void run(const Arguments& a) {
  const pipeline::ReconstructOptions options = to_options(a);
  a.scene.check_output(a.out);
  TerminalProgress progress(pipeline::total_weight(options));
  const pipeline::Report report = pipeline::reconstruct(options, progress);
  progress.finish();
  if (a.json)
    std::fputs(report.to_json().c_str(), stdout);
  else
    print_summary(report, a.out);
  throw_if_failed(report.verdict);
}

void add_options(CLI::App& c, Arguments& a) {
  a.scene.add_to(c);
  c.add_option("--out", a.out, "folder for the results; made when it does not exist")->required();
  c.add_option("--resolution", a.resolution, "voxels along the box's longest side");
  c.add_option("--voxel-size", a.voxel_size, "voxel size in world units");
  c.add_option(
       "--lattice", a.lattice,
       "fit (voxels centred on the box) or fixed: they begin in the box's lower corner, and "
       "box and voxel size alone say where they are, for results that are to be compared or "
       "follow each other")
      ->capture_default_str();
  c.add_flag(
      "--box-exact", a.box_exact,
      "take the box as it is: not made smaller where the object is, and no surface beyond it");
  c.add_option("--quality", a.quality, "draft, normal or high: voxel size from the images' pixels")
      ->capture_default_str();
  c.add_option("--method", a.method,
               "hull, voxel-coloring, space-carving or refine (default: hull for draft, else "
               "refine)");
  c.add_option("--sampler", a.sampler,
               "sweeps: mipmap, centroid, nearest, bilinear, trilinear, trilinear-derivative, "
               "ripmap, summed-area, anisotropic, hardware or ewa (default: anisotropic)");
  c.add_option("--supersample", a.supersample,
               "sweeps: N x N samples a voxel, 1 to 8 (default: 1)");
  c.add_option("--consistency", a.consistency,
               "sweeps: zncc, gain-variance, adaptive-variance, robust-variance, histogram or "
               "census (default: zncc)");
  c.add_option(
      "--visibility", a.visibility,
      "sweeps: who sees a voxel: plain, receiver-plane, virtual-normal, pcf3, pcf3-virtual "
      "or rays (default: plain)");
  c.add_option("--r-consistency", a.r_consistency,
               "sweeps: pixels around its projection, 0 to 4, within which each view may show a "
               "voxel: bears cameras that are wrong by as much (default: 0)");
  c.add_option("--mesh-error", a.mesh_error,
               "fewer triangles: how far mesh.ply may be from the uniform mesh, in voxels, or with "
               "a u in world units (0: uniform)")
      ->capture_default_str();
  c.add_option(
       "--unseen", a.unseen,
       "surface that no camera sees: closed, open (left out; without masks what is doubtful, "
       "too), or auto: closed where there are masks")
      ->capture_default_str();
  c.add_option(
       "--surroundings", a.surroundings,
       "what surrounds the box, on coarser grids: on, off, or auto: where the box was found, and "
       "fewer than half of the photographs have masks")
      ->capture_default_str();
  c.add_option("--refine-cameras", a.refine_cameras,
               "off, auto (where it pays), poses or poses+intrinsics: cameras made to agree with "
               "the photographs first (default: off for draft, else auto where masks' outlines "
               "show that cameras are wrong)");
  c.add_option("--photometric", a.photometric,
               "off, auto (where gains differ by more than the noise of their estimate, and "
               "correcting them pays) or on: gains, white balance and vignetting of the "
               "photographs made alike, for colours and confidence")
      ->capture_default_str();
  c.add_option("--mask-offset", a.mask_offset,
               "pixels by which the object's outline lies outside the masks' (negative: inside), "
               "or auto: measured on the photographs")
      ->capture_default_str();
  c.add_option("--mask-holes", a.mask_holes,
               "mend (holes and bites of given masks where the photograph shows the object's "
               "colours) or keep")
      ->capture_default_str();
  c.add_option("--views-may-miss", a.views_may_miss,
               "silhouettes that may leave a point out and it stands all the same, or auto: up to "
               "a third of the views, and only where masks show what would be missing otherwise")
      ->capture_default_str();
  c.add_option("--noise", a.noise,
               "standard deviation of the photographs' noise in 8-bit codes (default: measured)");
  c.add_flag("--keep-views", a.keep_views,
             "use views whose silhouettes disagree with all others' and views that are strongly "
             "blurred, too");
  c.add_option("--image-scale", a.image_scale,
               "at which photographs are read: 1, 1/2, 1/4, 1/8 or any number up to 1, or auto: "
               "what --resolution or --voxel-size needs, and --max-memory bears")
      ->capture_default_str();
  c.add_option("--max-memory", a.max_memory,
               "that the job may take, such as 512M or 2G, or auto: three quarters of what is "
               "available")
      ->capture_default_str();
  c.add_option("--device", a.device, "auto, software, or an index from 'photohull devices'")
      ->capture_default_str();
  c.add_option("--threads", a.threads, "threads to use (0: one a core)")->capture_default_str();
  c.add_option("--tune", a.tune,
               "NAME=VALUE: a parameter of the method changed, for experiments (repeatable)");
  c.add_flag("--evidence", a.evidence,
             "write evidence.ply too, the uniform mesh with what confidence is computed from, and "
             "missing.png: where the model leaves the masks empty, or without masks explained.png: "
             "what of a photograph it explains");
  c.add_flag("--fresh", a.fresh,
             "start anew: else an interrupted refinement of the same job goes on after the last "
             "level that it finished");
  c.add_flag("--json", a.json, "print report.json on standard output instead of a summary");
}

}  // namespace

void check_reconstruct(const std::vector<std::string>& arguments) {
  CLI::App command("", "reconstruct");
  Arguments a;
  add_options(command, a);
  std::vector<const char*> words = {"reconstruct", "scene", "--out", "out"};
  for (const std::string& word : arguments) words.push_back(word.c_str());
  try {
    command.parse(int(words.size()), words.data());
  } catch (const CLI::ParseError& e) {
    throw UsageError(parse_fault(command, e));
  }
  to_options(a);
}

void add_reconstruct(CLI::App& app) {
  auto a = std::make_shared<Arguments>();
  CLI::App* c = add_command(app, "reconstruct");
  add_options(*c, *a);
  c->footer(
      "Writes volume.vdb, mesh.ply, preview.png and report.json into the output folder.\n\n"
      "Examples:\n"
      "  photohull reconstruct datasets/templeSparseRing --out out/temple\n"
      "  photohull reconstruct scan --out out/scan --quality draft\n"
      "  photohull reconstruct scan --out out/scan --resolution 512 --method hull\n"
      "  photohull reconstruct scan --out out/scan --mesh-error 0.25 --unseen open\n"
      "  photohull reconstruct colmap/sparse/0 --out out/plant --box \"-1 -1 0 1 1 2\"\n"
      "  photohull reconstruct transforms.json --out out/x --masks my_masks --views 0-23 --json");
  c->callback([a] { run(*a); });
}

}  // namespace photohull::cli

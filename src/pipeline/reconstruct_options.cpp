// What a job's options mean, and which make sense.
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdlib>

#include "carving/hull.h"
#include "carving/photo.h"
#include "carving/search_disc.h"
#include "core/error.h"
#include "core/option_word.h"
#include "gpu/device_options.h"
#include "pipeline/export_options.h"
#include "pipeline/image_scale.h"
#include "pipeline/memory.h"
#include "pipeline/methods/method.h"
#include "pipeline/reconstruct_options.h"
#include "pipeline/tuning.h"

namespace photohull::pipeline {
namespace {

constexpr double kFarthestMaskOffset = 100;  // pixels
constexpr double kMostNoise = 255;           // 8-bit codes

/// Throws UsageError for options of the plane sweep where there is none.
void check_sweep_options(const ReconstructOptions& o) {
  if (method_of(o).sweeps) return;
  const char* given = o.sampler         ? "sampler"
                      : o.supersample   ? "supersample"
                      : o.consistency   ? "consistency"
                      : o.visibility    ? "visibility"
                      : o.r_consistency ? "r_consistency"
                                        : nullptr;
  if (given)
    throw UsageError(concat(option_word(given), ": ", option_word("method", method_of(o).name),
                            " has no plane sweep; give ", option_word("method", "space-carving"),
                            " or voxel-coloring"));
}

/// Throws UsageError for options that a part has none of, for the whole gives them.
void check_part(const ReconstructOptions& o) {
  if (!o.part && o.finer != 1)
    throw UsageError(concat(option_word("finer", o.finer), " is for parts: give ",
                            option_word("part"), " or, for a batch, ", option_word("parts")));
  if (!o.part) return;
  const std::string part = option_word("part", to_string(*o.part));
  if (!method_of(o).in_parts)
    throw UsageError(concat(part, ": ", option_word("method", method_of(o).name),
                            " is not made in parts; refine and hull are"));
  if (o.follow.empty())
    throw UsageError(concat(part, ": ", option_word("follow"),
                            " has to name the results of the whole, on coarser voxels"));
  const char* given = o.resolution                          ? "resolution"
                      : o.voxel_size                        ? "voxel_size"
                      : o.box.find || o.box.exact           ? "box"
                      : o.lattice == Lattice::kFixed        ? "lattice"
                      : o.surroundings == Surroundings::kOn ? "surroundings"
                      : o.unseen == Unseen::kOpen           ? "unseen"
                      : o.mesh_error.value > 0              ? "mesh_error"
                      : o.evidence                          ? "evidence"
                      : !o.exports.empty()                  ? "export"
                                                            : nullptr;
  if (given)
    throw UsageError(concat(part, ": ", option_word(given),
                            " is the whole's matter, or that of the parts when they are joined"));
}

/// Throws UsageError for options that exclude each other.
void check_combinations(const ReconstructOptions& o) {
  const std::string resolution = option_word("resolution"), voxel_size = option_word("voxel_size"),
                    fixed = option_word("lattice", "fixed");
  if (o.resolution && o.voxel_size)
    throw UsageError(concat(resolution, " and ", voxel_size, " exclude each other: give one"));
  if (o.lattice == Lattice::kFixed && !o.resolution && !o.voxel_size)
    throw UsageError(concat(fixed, ": give ", voxel_size, " or ", resolution,
                            ", for the voxels of ", option_word("quality"),
                            " follow the photographs"));
  if (o.lattice == Lattice::kFixed && o.box.find)
    throw UsageError(concat(fixed, ": ", option_word("box", "auto"),
                            " follows the photographs; give the box's corners, or leave ",
                            option_word("box"), " out where the scene has one"));
  if (o.surroundings == Surroundings::kOn && !method_of(o).carve_around)
    throw UsageError(concat(option_word("surroundings", "on"), ": ",
                            option_word("method", method_of(o).name),
                            " has none; they are made by ", option_word("method", "refine")));
  if (!o.follow.empty() && !o.part && !method_of(o).follows)
    throw UsageError(concat(option_word("follow"), ": ", option_word("method", method_of(o).name),
                            " starts from no surface; give ", option_word("rig"),
                            " for cameras and gains alone"));
  check_part(o);
  check_sweep_options(o);
}

/// Voxels (0.25) or world units (0.002u).
std::optional<MeshError> read_mesh_error(const std::string& text) {
  MeshError error;
  char* end = nullptr;
  error.value = std::strtod(text.c_str(), &end);
  error.world_units = end != text.c_str() && *end == 'u';
  const bool whole = end != text.c_str() && *(end + (error.world_units ? 1 : 0)) == 0;
  if (!whole || !std::isfinite(error.value) || error.value < 0) return std::nullopt;
  return error;
}

Words mesh_error_words(MeshError& error) {
  return {[&error] {
            return text_of({.name = "", .place = &error.value}) + (error.world_units ? "u" : "");
          },
          [&error](const std::string& text) {
            const std::optional<MeshError> read = read_mesh_error(text);
            if (read) error = *read;
            return read.has_value();
          }};
}

Words mask_hole_words(bool& keep) {
  return {[&keep] { return std::string(keep ? "keep" : "mend"); },
          [&keep](const std::string& text) {
            if (text != "keep" && text != "mend") return false;
            keep = text == "keep";
            return true;
          }};
}

void describe_voxels(Described& to, ReconstructOptions& o, io::LoadSceneOptions& load) {
  to.choice("quality", &o.quality, std::array{Quality::kDraft, Quality::kNormal, Quality::kHigh},
            "voxel size from the images' pixels, and how much work is done")
      .always = true;
  std::vector<Method> all;
  for (const MethodEntry& entry : methods()) all.push_back(entry.method);
  to.choice("method", &o.method, all, "how space is carved (default: hull for draft, else refine)")
      .always = true;
  to.number("resolution", &o.resolution, at_least(2), "voxels",
            "voxels along the box's longest side");
  to.number("voxel_size", &o.voxel_size, above(0), "world units",
            "voxel size in world units; excludes the resolution");
  io::describe_views(to, load);
  describe(to, o.box, load.box);
  to.choice("lattice", &o.lattice, std::array{Lattice::kFit, Lattice::kFixed},
            "fit (voxels centred on the box) or fixed: they begin in the box's lower corner, and "
            "box and voxel size alone say where they are, for results that are to be compared or "
            "follow each other");
}

void describe_outcome(Described& to, ReconstructOptions& o) {
  to.choice("refine_cameras", &o.refine_cameras,
            std::array{RefineCameras::kOff, RefineCameras::kAuto, RefineCameras::kPoses,
                       RefineCameras::kPosesAndIntrinsics},
            "cameras made to agree with the photographs first, auto where it pays (default: off "
            "for draft, else auto where masks' outlines show that cameras are wrong)");
  to.affects(Stage::kSurface);
  to.choice("photometric", &o.photometric,
            std::array{Photometric::kOff, Photometric::kAuto, Photometric::kOn},
            "gains, white balance and vignetting of the photographs made alike, for colours and "
            "confidence; auto where gains differ by more than the noise of their estimate, and "
            "correcting them pays")
      .always = true;
  to.affects(Stage::kMesh);
  Option& error = to.text("mesh_error", mesh_error_words(o.mesh_error),
                          "fewer triangles: how far mesh.ply may be from the uniform mesh (0: "
                          "uniform)");
  error.expects = "0 or a positive number, of voxels (0.25) or, with a u, of world units (0.002u)";
  error.always = true;
  to.choice("unseen", &o.unseen, std::array{Unseen::kAuto, Unseen::kOpen, Unseen::kClosed},
            "surface that no camera sees: closed, open (left out; without masks what is doubtful, "
            "too), or auto: closed where there are masks")
      .always = true;
  to.affects(Stage::kViews);
  to.choice("surroundings", &o.surroundings,
            std::array{Surroundings::kAuto, Surroundings::kOn, Surroundings::kOff},
            "what surrounds the box, on coarser grids: on (with the method refine only), off, or "
            "auto: where the box was found, and fewer than half of the photographs have masks")
      .always = true;
}

void describe_masks(Described& to, ReconstructOptions& o) {
  Option& offset = to.number("mask_offset", &o.mask_offset,
                             from_to(-kFarthestMaskOffset, kFarthestMaskOffset), "pixels",
                             "pixels by which the object's outline lies outside the masks' "
                             "(negative: inside); auto: measured on the photographs");
  offset.absent = "auto";
  offset.always = true;
  Option& miss = to.number(
      "views_may_miss", &o.views_may_miss, from_to(0, carving::HullOptions::kMostMissing), "views",
      "silhouettes that may leave a point out and it stands all the same; auto: up to a third of "
      "the views, and only where masks show what would be missing otherwise");
  miss.absent = "auto";
  miss.expects =
      concat("auto, or a number of views from 0 to ", carving::HullOptions::kMostMissing);
  miss.always = true;
  to.affects(Stage::kViews);
  to.text("mask_holes", mask_hole_words(o.keep_mask_holes),
          "mend holes and bites of given masks where the photograph shows the object's colours, or "
          "keep them")
      .expects = "mend or keep";
  to.number("noise", &o.noise, from_to(0, kMostNoise), "8-bit codes",
            "standard deviation of the photographs' noise in 8-bit codes (default: measured)");
  to.affects(Stage::kHull);
  to.flag("keep_views", &o.keep_views,
          "use views whose silhouettes disagree with all others' and views that are strongly "
          "blurred, too");
}

void describe_sweeps(Described& to, ReconstructOptions& o) {
  to.choice("sampler", &o.sampler, projtex::kSamplers,
            concat("sweeps: how photographs are resampled on their planes (default: ",
                   projtex::to_string(projtex::kDefaultSampler), ")"));
  to.number("supersample", &o.supersample, from_to(1, projtex::kMaxSupersample), "",
            "sweeps: N x N samples a voxel (default: 1)");
  to.choice("consistency", &o.consistency, carving::all_statistics(),
            concat("sweeps: what decides whether views agree on a voxel (default: ",
                   carving::to_string(carving::PhotoOptions().statistic), ")"));
  to.choice("visibility", &o.visibility, visibility::kSweepTests,
            concat("sweeps: how it is known who sees a voxel (default: ",
                   visibility::to_string(visibility::kDefaultSweepTest), ")"));
  to.number("r_consistency", &o.r_consistency, from_to(0, carving::kMaxSearchRadius), "pixels",
            "sweeps: pixels around its projection within which each view may show a voxel: bears "
            "cameras that are wrong by as much (default: 0)")
      .expects = concat("0 to ", carving::kMaxSearchRadius, " pixels");
}

void describe_earlier(Described& to, ReconstructOptions& o) {
  to.text("follow", &o.follow,
          "results of the moment before, of the same rig: the surface starts from theirs (refine), "
          "and their cameras and gains hold");
  to.text("rig", &o.rig,
          "results of the same rig: their cameras and gains hold, and nothing of them is measured "
          "again");
  to.text(
        "part", part_words(o.part),
        "of the whole whose results are followed, on voxels that are halved, one part of so many, "
        "for models larger than memory ('photohull plan' with parts makes them all)")
      .expects =
      concat("a part and their number, such as 3/8, up to ", PartNumber::kMost, ", or all");
  to.number("finer", &o.finer, from_to(1, 4), "",
            "how often the whole's voxels are halved for its parts");
}

void describe_run(Described& to, ReconstructOptions& o) {
  Option& scale = to.number("image_scale", &o.image_scale, above(0, 1), "",
                            "at which photographs are read; auto: what the voxels need, and the "
                            "memory bears");
  scale.absent = "auto";
  scale.expects = "auto, or a scale above 0 and up to 1, such as 1/4 or 0.3";
  scale.notation = parse_image_scale;
  scale.always = true;
  Option& memory =
      to.number("max_memory", &o.max_memory, at_least(1), "bytes",
                "memory that the job may take; auto: three quarters of what is available");
  memory.absent = "auto";
  memory.expects = "auto, or a size with its unit such as 512M or 2G";
  memory.notation = parse_max_memory;
  to.text("tune", &o.tune,
          "NAME=VALUE: a parameter of the method changed, for experiments (repeatable)");
  to.affects(Stage::kHull);
  gpu::describe_device(to, o.device).always = true;
  to.affects(Stage::kNothing);
  gpu::describe_threads(to, o.threads).always = true;
  to.flag(
      "fresh", &o.fresh,
      "start anew: else an interrupted refinement of the same job goes on after the last level "
      "that it finished, and masks and cameras that the run before in this folder made by the same "
      "photographs are taken from there");
  to.affects(Stage::kFiles);
  to.flag("evidence", &o.evidence,
          "write evidence.ply too, the uniform mesh with what confidence is computed from, and "
          "missing.png: where the model leaves the masks empty, or without masks explained.png: "
          "what of a photograph it explains");
  to.choice("report_page", &o.report_page, std::array{ReportPage::kOn, ReportPage::kOff},
            "write report.html, too: the model to turn, its cameras, the verdict and the figures, "
            "as one page for a browser");
  describe_exports(to, o);
}

/// Those that take effect, in words.
template <typename Take>
void for_reported(ReconstructOptions options, io::LoadSceneOptions load, const Take& take) {
  options.method = options.effective_method();
  ReconstructOptions defaults;
  io::LoadSceneOptions usual_load;
  Described given, usual;
  describe(given, options, load);
  describe(usual, defaults, usual_load);
  for (const Option& option : given.options()) {
    const std::string text = text_of(option);
    if (option.always || text != text_of(*usual.find(option.name))) take(option, text);
  }
}

}  // namespace

const char* to_string(Quality quality) {
  switch (quality) {
    case Quality::kDraft:
      return "draft";
    case Quality::kNormal:
      return "normal";
    case Quality::kHigh:
      return "high";
  }
  return "?";
}

const char* to_string(Unseen unseen) {
  switch (unseen) {
    case Unseen::kAuto:
      return "auto";
    case Unseen::kOpen:
      return "open";
    case Unseen::kClosed:
      return "closed";
  }
  return "?";
}

const char* to_string(Lattice lattice) { return lattice == Lattice::kFixed ? "fixed" : "fit"; }

const char* to_string(Surroundings surroundings) {
  switch (surroundings) {
    case Surroundings::kAuto:
      return "auto";
    case Surroundings::kOn:
      return "on";
    case Surroundings::kOff:
      return "off";
  }
  return "?";
}

const char* to_string(ReportPage page) { return page == ReportPage::kOn ? "on" : "off"; }

double footprint_factor(Quality quality, bool silhouettes) {
  switch (quality) {
    case Quality::kDraft:
      return 4.0;
    case Quality::kNormal:
      return silhouettes ? 1.5 : 2.0;
    case Quality::kHigh:
      return silhouettes ? 1.25 : 1.5;
  }
  return 1.5;
}

void ReconstructOptions::validate() const {
  ReconstructOptions copy = *this;
  io::LoadSceneOptions usual;
  Described described;
  describe(described, copy, usual);
  described.check_given();
  const bool index = !device.empty() && device.find_first_not_of("0123456789") == std::string::npos;
  if (device != "auto" && device != "software" && !index)
    throw UsageError(concat(option_word("device", device),
                            ": expected auto, software or an index of 'photohull devices'"));
  if (!(std::isfinite(mesh_error.value) && mesh_error.value >= 0))
    throw UsageError(
        concat(option_word("mesh_error", mesh_error.value), ": must be finite, 0 or more"));
  check_exports(*this);
  check_combinations(*this);
  tuned(*this);
}

void describe(Described& to, ReconstructOptions& o, io::LoadSceneOptions& load) {
  describe_voxels(to, o, load);
  describe_outcome(to, o);
  io::describe_reading(to, load);
  to.affects(Stage::kHull);
  describe_masks(to, o);
  to.affects(Stage::kSurface);
  describe_sweeps(to, o);
  to.affects(Stage::kViews);
  describe_earlier(to, o);
  describe_run(to, o);
}

Method ReconstructOptions::effective_method() const {
  if (method) return *method;
  return quality == Quality::kDraft ? Method::kHull : Method::kRefine;
}

NamedValues named_options(const ReconstructOptions& options, const io::LoadSceneOptions& load) {
  NamedValues list;
  for_reported(options, load, [&](const Option& option, const std::string& text) {
    list.emplace_back(option.name, text);
  });
  return list;
}

std::string option_line(const ReconstructOptions& options, const io::LoadSceneOptions& load) {
  std::string line;
  for_reported(options, load, [&](const Option& option, const std::string& text) {
    if (option.from < Stage::kFiles) line += (line.empty() ? "" : " ") + option.name + "=" + text;
  });
  return line;
}

}  // namespace photohull::pipeline

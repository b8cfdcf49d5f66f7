// What a job's options mean, and which make sense.
#include <charconv>
#include <cmath>

#include "carving/hull.h"
#include "carving/photo.h"
#include "carving/search_disc.h"
#include "core/error.h"
#include "pipeline/reconstruct.h"
#include "pipeline/tuning.h"
#include "refine/refine.h"

namespace photohull::pipeline {
namespace {

constexpr double kFarthestMaskOffset = 100;  // pixels
constexpr double kMostNoise = 255;           // 8-bit codes

/// Throws UsageError for options of the plane sweep where there is none.
void check_sweep_options(const ReconstructOptions& o) {
  if (o.supersample && (*o.supersample < 1 || *o.supersample > projtex::kMaxSupersample))
    throw UsageError(
        concat("--supersample ", *o.supersample, ": expected 1 to ", projtex::kMaxSupersample));
  if (o.r_consistency && !(*o.r_consistency >= 0 && *o.r_consistency <= carving::kMaxSearchRadius))
    throw UsageError(concat("--r-consistency ", *o.r_consistency, ": expected 0 to ",
                            carving::kMaxSearchRadius, " pixels"));
  const Method method = o.effective_method();
  if (method == Method::kVoxelColoring || method == Method::kSpaceCarving) return;
  const char* given = o.sampler         ? "--sampler"
                      : o.supersample   ? "--supersample"
                      : o.consistency   ? "--consistency"
                      : o.visibility    ? "--visibility"
                      : o.r_consistency ? "--r-consistency"
                                        : nullptr;
  if (given)
    throw UsageError(concat(given, ": --method ", to_string(method),
                            " has no plane sweep; give --method space-carving or voxel-coloring"));
}

/// Throws UsageError for parameters that the method does not have or take.
void check_tuning(const std::vector<std::string>& assignments, Method method) {
  if (method == Method::kRefine) {
    refine::RefineOptions o;
    SharpenOptions sharpen;
    tune(assignments, o, sharpen);
    o.validate();
    sharpen.validate();
  } else if (method != Method::kHull) {
    carving::PhotoOptions o;
    tune(assignments, o);
    o.validate();
  } else if (!assignments.empty()) {
    throw UsageError(concat("--tune ", assignments[0], ": the hull has no parameters"));
  }
}

std::string number(double value) {
  std::ostringstream out;
  out.precision(9);
  out << value;
  return out.str();
}

std::string mask_option(const io::LoadSceneOptions& load) {
  switch (load.masks) {
    case io::MaskSource::kAuto:
      return "auto";
    case io::MaskSource::kBackground:
      return "background";
    case io::MaskSource::kNone:
      return "none";
    case io::MaskSource::kDirectory:
      break;
  }
  return load.mask_directory.string();
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

const char* to_string(Method method) {
  switch (method) {
    case Method::kHull:
      return "hull";
    case Method::kVoxelColoring:
      return "voxel-coloring";
    case Method::kSpaceCarving:
      return "space-carving";
    case Method::kRefine:
      return "refine";
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

MeshError parse_mesh_error(const std::string& text) {
  MeshError error;
  char* end = nullptr;
  error.value = std::strtod(text.c_str(), &end);
  error.world_units = end != text.c_str() && *end == 'u';
  const bool whole = end != text.c_str() && *(end + (error.world_units ? 1 : 0)) == 0;
  if (!whole || !std::isfinite(error.value) || error.value < 0)
    throw UsageError(concat("--mesh-error ", text,
                            ": expected 0 or a positive number, of voxels (0.25) or, with a u, of "
                            "world units (0.002u)"));
  return error;
}

std::optional<int> parse_views_may_miss(const std::string& text) {
  if (text == "auto") return std::nullopt;
  int value = 0;
  const char* end = text.data() + text.size();
  const auto [last, problem] = std::from_chars(text.data(), end, value);
  if (problem != std::errc() || last != end || value < 0 ||
      value > carving::HullOptions::kMostMissing)
    throw UsageError(concat("--views-may-miss ", text,
                            ": expected auto, or a number of views from 0 to ",
                            carving::HullOptions::kMostMissing));
  return value;
}

std::optional<double> parse_mask_offset(const std::string& text) {
  if (text == "auto") return std::nullopt;
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || *end != 0 || !(std::abs(value) <= kFarthestMaskOffset))
    throw UsageError(concat("--mask-offset ", text, ": expected auto, or pixels from ",
                            -kFarthestMaskOffset, " to ", kFarthestMaskOffset));
  return value;
}

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
  load.validate();
  box.validate();
  if (output.empty()) throw UsageError("--out is empty: give a folder for the results");
  const bool index = !device.empty() && device.find_first_not_of("0123456789") == std::string::npos;
  if (device != "auto" && device != "software" && !index)
    throw UsageError(concat("--device ", device,
                            ": expected auto, software or an index of 'photohull devices'"));
  if (resolution && voxel_size)
    throw UsageError("--resolution and --voxel-size exclude each other: give one");
  if (resolution && *resolution < 2)
    throw UsageError(concat("--resolution ", *resolution, ": at least 2"));
  if (voxel_size && !(std::isfinite(*voxel_size) && *voxel_size > 0))
    throw UsageError(concat("--voxel-size ", *voxel_size, ": must be finite and positive"));
  if (lattice == Lattice::kFixed && !resolution && !voxel_size)
    throw UsageError(
        "--lattice fixed: give --voxel-size or --resolution, for the voxels of --quality follow "
        "the "
        "photographs");
  if (lattice == Lattice::kFixed && box.find)
    throw UsageError(
        "--lattice fixed: --box auto follows the photographs; give the box's corners, or leave "
        "--box out where the scene has one");
  if (!(std::isfinite(mesh_error.value) && mesh_error.value >= 0))
    throw UsageError(concat("--mesh-error ", mesh_error.value, ": must be finite, 0 or more"));
  if (noise && !(*noise >= 0 && *noise <= kMostNoise))
    throw UsageError(concat("--noise ", *noise, ": expected 8-bit codes from 0 to ", kMostNoise));
  if (image_scale && !(*image_scale > 0 && *image_scale <= 1))
    throw UsageError(concat("--image-scale ", *image_scale, ": expected above 0 and up to 1"));
  if (max_memory && *max_memory < 1)
    throw UsageError(concat("--max-memory ", *max_memory, ": expected a positive size"));
  if (threads < 0) throw UsageError(concat("--threads ", threads, ": 0 (one a core) or more"));
  if (surroundings == Surroundings::kOn && effective_method() != Method::kRefine)
    throw UsageError(concat("--surroundings on: --method ", to_string(effective_method()),
                            " has none; they are made by --method refine"));
  check_sweep_options(*this);
  check_tuning(tune, effective_method());
}

Method ReconstructOptions::effective_method() const {
  if (method) return *method;
  return quality == Quality::kDraft ? Method::kHull : Method::kRefine;
}

NamedValues named_options(const ReconstructOptions& options) {
  NamedValues list;
  list.emplace_back("quality", to_string(options.quality));
  list.emplace_back("method", to_string(options.effective_method()));
  if (options.resolution) list.emplace_back("resolution", concat(*options.resolution));
  if (options.voxel_size) list.emplace_back("voxel_size", number(*options.voxel_size));
  if (!options.load.views.empty()) list.emplace_back("views", options.load.views);
  if (!options.load.hold_out.empty()) list.emplace_back("hold_out", options.load.hold_out);
  if (options.box.find) list.emplace_back("box", "auto");
  if (options.box.scale != 1) list.emplace_back("box_scale", number(options.box.scale));
  if (options.box.exact) list.emplace_back("box_exact", "true");
  if (options.lattice != Lattice::kFit) list.emplace_back("lattice", to_string(options.lattice));
  if (options.refine_cameras)
    list.emplace_back("refine_cameras", to_string(*options.refine_cameras));
  list.emplace_back("photometric", to_string(options.photometric));
  list.emplace_back("mesh_error",
                    number(options.mesh_error.value) + (options.mesh_error.world_units ? "u" : ""));
  list.emplace_back("unseen", to_string(options.unseen));
  list.emplace_back("surroundings", to_string(options.surroundings));
  list.emplace_back("masks", mask_option(options.load));
  list.emplace_back("mask_offset", options.mask_offset ? number(*options.mask_offset) : "auto");
  list.emplace_back("views_may_miss",
                    options.views_may_miss ? concat(*options.views_may_miss) : "auto");
  if (options.keep_mask_holes) list.emplace_back("mask_holes", "keep");
  if (options.noise) list.emplace_back("noise", number(*options.noise));
  if (options.keep_views) list.emplace_back("keep_views", "true");
  if (!options.load.background.empty())
    list.emplace_back("background", options.load.background.string());
  if (options.load.pixel_center)
    list.emplace_back("pixel_center", number(*options.load.pixel_center));
  list.emplace_back("image_scale", options.image_scale ? number(*options.image_scale) : "auto");
  if (options.max_memory) list.emplace_back("max_memory", concat(*options.max_memory));
  std::string tuning;
  for (const std::string& assignment : options.tune)
    tuning += (tuning.empty() ? "" : " ") + assignment;
  if (!tuning.empty()) list.emplace_back("tune", tuning);
  list.emplace_back("device", options.device);
  list.emplace_back("threads", concat(options.threads));
  return list;
}

}  // namespace photohull::pipeline

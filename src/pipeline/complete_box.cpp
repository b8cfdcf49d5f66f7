#include "pipeline/complete_box.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "cameras/feature_tracks.h"
#include "cameras/triangulate.h"
#include "core/error.h"
#include "core/option_word.h"
#include "io/spread_views.h"
#include "pipeline/find_box.h"
#include "pipeline/image_scale.h"

namespace photohull::pipeline {
namespace {

constexpr const char* kFindBox = "auto";

constexpr int kLongestSide = 800;       // pixels of reduced photographs
constexpr std::size_t kMostViews = 60;  // that are looked at: a few seconds' work
constexpr double kLargestResidual = 4;  // pixels of the photographs, of the scene file's tracks
constexpr const char* kSparsePoints = "sparse points";  // io/load_scene.cpp's name for its guess

/// The scene with these views alone.
Scene scene_of(const Scene& scene, const std::vector<std::size_t>& kept) {
  Scene out;
  out.path = scene.path;
  for (const std::size_t i : kept) out.views.push_back(scene.views[i]);
  return out;
}

/// Of each view, so that no photograph is larger than kLongestSide.
std::vector<double> reduced_scales(const Scene& scene) {
  std::vector<double> scales;
  for (const SourceView& view : scene.views) {
    const Intrinsics& k = view.camera.intrinsics;
    scales.push_back(std::min(1.0, double(kLongestSide) / std::max(k.width, k.height)));
  }
  return scales;
}

/// The scene file's points, with the kept views that show them where it lists tracks.
std::vector<ScenePoint> listed_points(const Scene& scene, const std::vector<std::size_t>& kept) {
  std::vector<PreparedView> views;
  std::vector<Camera> cameras;
  for (const SourceView& v : scene.views) {
    views.push_back({v.name, v.camera, {}, {}});
    cameras.push_back(v.camera);
  }
  std::vector<ScenePoint> points;
  for (const Track& track : undistorted_tracks(scene, views)) {
    const auto point = triangulate(cameras, track);
    if (!point || !(reprojection_rms(cameras, track, *point) < kLargestResidual)) continue;
    ScenePoint listed{*point, {}};
    for (const Observation& o : track.observations) {
      const auto at = std::lower_bound(kept.begin(), kept.end(), std::size_t(o.view));
      if (at != kept.end() && *at == std::size_t(o.view))
        listed.views.push_back(int(at - kept.begin()));
    }
    points.push_back(std::move(listed));
  }
  if (points.size() < scene.points.size() / 2) {
    points.clear();
    for (const glm::dvec3& p : scene.points) points.push_back({p, {}});
  }
  return points;
}

bool were_given(const PreparedViews& prepared) {
  return std::any_of(prepared.masks.begin(), prepared.masks.end(), [](const MaskJudgement& m) {
    return m.source == "mask files" || m.source == "alpha channels";
  });
}

FoundBox find_in_photographs(MaskPolicy masks, const PhotographReader& reader, const Scene& scene,
                             Progress& progress) {
  std::vector<std::size_t> kept = io::spread_views(scene.views, scene.box, kMostViews);
  Scene reduced = scene_of(scene, kept);
  const std::vector<double> scales = reduced_scales(reduced);
  const ViewLoader loader = reduced_loader(reader, reduced, scales);
  scale_scene(scales, reduced);
  PrepareOptions options;
  options.masks = masks;
  const PreparedViews prepared = prepare_views(reduced, loader, options, progress);
  // What could not be decoded is not among them; the job itself will name it.
  std::erase_if(kept, [&](std::size_t i) {
    return std::none_of(reduced.views.begin(), reduced.views.end(),
                        [&](const SourceView& view) { return view.name == scene.views[i].name; });
  });
  return find_box({prepared.views, were_given(prepared), listed_points(scene, kept)}, progress);
}

Box parse_box(const std::string& text) {
  std::string spaced = text;
  std::replace(spaced.begin(), spaced.end(), ',', ' ');
  std::istringstream in(spaced);
  double v[6];
  for (double& x : v)
    if (!(in >> x))
      throw UsageError(concat(option_word("box"),
                              ": expected auto or six numbers \"x0 y0 z0 x1 y1 z1\", found '", text,
                              "'"));
  std::string rest;
  if (in >> rest)
    throw UsageError(concat(option_word("box"), ": '", rest, "' follows the six numbers"));
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};  // swapped corners are told with the scene
}

Words box_words(BoxOptions& o, std::optional<Box>& given) {
  return {[&o, &given]() -> std::string {
            if (o.find) return kFindBox;
            if (!given) return "";
            const auto& [low, high] = *given;
            std::ostringstream out;
            out.precision(9);
            out << low.x << ' ' << low.y << ' ' << low.z << ' ' << high.x << ' ' << high.y << ' '
                << high.z;
            return out.str();
          },
          [&o, &given](const std::string& text) {
            o.find = text == kFindBox;
            given.reset();
            if (!o.find) given = parse_box(text);
            return true;
          }};
}

}  // namespace

void BoxOptions::validate() const {
  BoxOptions copy = *this;
  std::optional<Box> none;
  Described to;
  describe(to, copy, none);
  for (const Option& option : to.options()) check_option(option);
}

void describe(Described& to, BoxOptions& o, std::optional<Box>& given) {
  to.text("box", box_words(o, given),
          "region of interest \"x0 y0 z0 x1 y1 z1\" in world units, or auto: found in the "
          "photographs (default: the scene's own, else auto)");
  to.number("box_scale", &o.scale, from_to(BoxOptions::kLeastScale, BoxOptions::kMostScale), "",
            "scales the box, whatever it is, about its middle")
      .expects = concat("a factor from ", BoxOptions::kLeastScale, " to ", BoxOptions::kMostScale);
  to.flag("box_exact", &o.exact,
          "take the box as it is: not made smaller where the object is, and no surface beyond it");
}

bool looks_for_box(const BoxOptions& options, const Scene& scene) {
  return options.find || !scene.box || scene.box_source == kSparsePoints;
}

BoxFindings complete_box(const BoxOptions& options, MaskPolicy masks, Scene& scene,
                         Progress& progress, const PhotographReader& reader) {
  options.validate();
  BoxFindings findings;
  if (looks_for_box(options, scene)) {
    const bool guessed = scene.box && scene.box_source == kSparsePoints;
    try {
      FoundBox found = find_in_photographs(masks, reader, scene, progress);
      scene.box = found.box;
      scene.box_source = std::move(found.source);
      scene.warnings.insert(scene.warnings.end(), found.warnings.begin(), found.warnings.end());
      findings = {true, std::move(found.points), found.seen};
    } catch (const Cancelled&) {
      throw;
    } catch (const MemoryError&) {
      throw;
    } catch (const Error& failure) {
      if (!guessed) throw Error(concat(scene.path.string(), ": ", failure.what()));
      scene.warnings.push_back(
          concat("the box is that of the sparse points, for ", failure.what()));
    }
  }
  if (options.scale != 1) {
    const glm::dvec3 middle = scene.box->center(), half = 0.5 * options.scale * scene.box->size();
    scene.box = Box{middle - half, middle + half};
    scene.box_source += concat(", scaled by ", options.scale);
  }
  return findings;
}

}  // namespace photohull::pipeline

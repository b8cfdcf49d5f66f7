#include "calib/prepare_views.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <mutex>

#include "calib/background.h"
#include "calib/masks.h"
#include "calib/undistort.h"
#include "core/error.h"

namespace photohull {
namespace {

constexpr double kDecodeShare = 0.6;  ///< of the stage's progress; masks and undistortion follow

ColourImage load_image(const SourceView& source, const ViewLoader& loader) {
  ColourImage image = loader.image(source.image);
  const Intrinsics& k = source.camera.intrinsics;
  if (image.width != k.width || image.height != k.height)
    throw Error(concat(source.image.string(), ": the picture has ", image.width, "x", image.height,
                       " pixels but its camera is for ", k.width, "x", k.height,
                       "; use the pictures that were calibrated"));
  return image;
}

/// Calls work(i) for every view in parallel, reports progress from `begin` to `end` and stops when
/// asked to.
template <typename Work>
void for_each_view(std::size_t count, double begin, double end, Progress& progress,
                   const Work& work) {
  std::mutex mutex;  // Progress need not be thread-safe
  std::size_t done = 0;
  tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) {
    progress.check_cancelled();
    work(i);
    const std::scoped_lock lock(mutex);
    progress.update(begin + (end - begin) * double(++done) / double(count));
  });
}

bool is_object_in_part(const Mask& mask) {
  const auto is_foreground = [](std::uint8_t coverage) { return coverage >= 128; };
  const auto& c = mask.coverage;
  return std::any_of(c.begin(), c.end(), is_foreground) &&
         !std::all_of(c.begin(), c.end(), is_foreground);
}

/// Masks of the views that have none and may have one, from the background model; rather none than
/// bad ones. Returns the model's separation.
double add_background_masks(const Scene& scene, PreparedViews& prepared,
                            std::vector<MaskOrigin>& origins) {
  std::vector<std::size_t> missing;
  std::vector<const ColourImage*> images;
  for (std::size_t i = 0; i < origins.size(); ++i)
    if (origins[i] == MaskOrigin::kNone && scene.views[i].silhouette) {
      missing.push_back(i);
      images.push_back(&prepared.views[i].image);
    }
  if (missing.empty()) return 0;
  const BackgroundModel model = estimate_background(images);
  if (!model.usable()) {
    prepared.warnings.push_back(
        concat(missing.size(),
               " views have no mask, and their background does not stand out "
               "enough to find one; carving must do without"));
    return 0;
  }
  std::vector<std::uint8_t> found(missing.size(), 0);
  tbb::parallel_for(std::size_t(0), missing.size(), [&](std::size_t i) {
    View& view = prepared.views[missing[i]];
    view.mask = mask_from_background(model, view.image);
    found[i] = is_object_in_part(view.mask);
  });
  const auto good = std::size_t(std::count(found.begin(), found.end(), 1));
  const bool use_any = 2 * good > missing.size();
  if (!use_any)
    prepared.warnings.push_back(concat("the background model finds the object in ", good, " of ",
                                       missing.size(), " views only; its masks are not used"));
  for (std::size_t i = 0; i < missing.size(); ++i) {
    View& view = prepared.views[missing[i]];
    if (use_any && found[i]) {
      origins[missing[i]] = MaskOrigin::kBackground;
      continue;
    }
    if (use_any)
      prepared.warnings.push_back(
          concat(view.name, ": the background model finds no mask; the view is used without"));
    view.mask = {};
  }
  return model.separation;
}

}  // namespace

void PrepareOptions::validate() const {
  if (!(max_frame_growth >= 1.0 && max_frame_growth <= 8.0))
    throw UsageError(concat("max_frame_growth must lie in [1, 8], not ", max_frame_growth));
}

PreparedViews prepare_views(const Scene& scene, const ViewLoader& loader,
                            const PrepareOptions& options, Progress& progress) {
  options.validate();
  const std::size_t count = scene.views.size();
  if (count == 0) throw Error(concat(scene.path.string(), ": lists no pictures"));
  const bool use_masks = options.masks == MaskPolicy::kAuto;
  PreparedViews result;
  result.views.resize(count);
  std::vector<MaskOrigin> origins(count, MaskOrigin::kNone);
  for_each_view(count, 0.0, kDecodeShare, progress, [&](std::size_t i) {
    const SourceView& source = scene.views[i];
    View& view = result.views[i];
    view.name = source.name;
    view.camera = source.camera;
    view.image = load_image(source, loader);
    if (use_masks) origins[i] = take_given_mask(source, loader, view);
    make_opaque(view.image);
  });

  check_masks(result);
  const double separation = use_masks ? add_background_masks(scene, result, origins) : 0;
  describe_masks(origins, separation, result);

  for_each_view(count, kDecodeShare, 1.0, progress, [&](std::size_t i) {
    undistort(scene.views[i].distortion, options.max_frame_growth, result.views[i]);
  });
  return result;
}

}  // namespace photohull

#include "views/prepare_views.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <mutex>

#include "core/error.h"
#include "core/left_out.h"
#include "views/undistort.h"

namespace photohull {
namespace {

constexpr double kDecodeShare = 0.6;  ///< of the stage's progress; masks and undistortion follow

/// False with the decoder's words where the picture cannot be decoded.
bool load_image(const SourceView& source, const ViewLoader& loader, ColourImage& image,
                std::string& failure) {
  try {
    image = loader.image(source.image);
  } catch (const MemoryError&) {
    throw;
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    failure = error.what();
    const std::string path = source.image.string() + ": ";
    if (failure.starts_with(path)) failure.erase(0, path.size());
    return false;
  }
  const Intrinsics& k = source.camera.intrinsics;
  if (image.width != k.width || image.height != k.height)
    throw Error(concat(source.image.string(), ": the picture has ", image.width, "x", image.height,
                       " pixels but its camera is for ", k.width, "x", k.height,
                       "; use the pictures that were calibrated"));
  return true;
}

void leave_out_unreadable(const std::vector<std::string>& failures, bool strict, Scene& scene,
                          std::vector<MaskOrigin>& origins, PreparedViews& prepared) {
  std::vector<LeftOutView> unreadable;
  std::vector<bool> keep;
  std::vector<PreparedView> views;
  std::vector<MaskOrigin> kept_origins;
  for (std::size_t i = 0; i < failures.size(); ++i) {
    const SourceView& source = scene.views[i];
    keep.push_back(failures[i].empty());
    if (!keep.back()) {
      unreadable.push_back(
          {source.name, source.image.string(), LeftOutView::Reason::kUnreadable, failures[i]});
      continue;
    }
    views.push_back(std::move(prepared.views[i]));
    kept_origins.push_back(origins[i]);
  }
  prepared.views = std::move(views);
  origins = std::move(kept_origins);
  keep_views(scene, keep);
  const auto warnings = note_left_out(scene, unreadable, strict);
  prepared.warnings.insert(prepared.warnings.end(), warnings.begin(), warnings.end());
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

}  // namespace

void describe(Described& to, PrepareOptions& o) {
  to.flag("grabcut", &o.cut_masks, "let GrabCut place the contours");
  to.number("max_frame_growth", &o.max_frame_growth, from_to(1, 8), "",
            "times that an undistorted picture may be as large as the photograph");
}

void PrepareOptions::validate() const { check_options(*this); }

PreparedViews prepare_views(Scene& scene, const ViewLoader& loader, const PrepareOptions& options,
                            Progress& progress, const MaskFinder& find) {
  options.validate();
  std::size_t count = scene.views.size();
  if (count == 0) throw Error(concat(scene.path.string(), ": lists no pictures"));
  const bool use_masks = options.masks != MaskPolicy::kNone;
  PreparedViews result;
  result.views.resize(count);
  std::vector<MaskOrigin> origins(count, MaskOrigin::kNone);
  std::atomic<int> of_ones = 0;              // masks
  std::vector<std::string> failures(count);  // the decoder's words; empty: none
  for_each_view(count, 0.0, kDecodeShare, progress, [&](std::size_t i) {
    const SourceView& source = scene.views[i];
    PreparedView& view = result.views[i];
    view.name = source.name;
    view.camera = source.camera;
    if (!load_image(source, loader, view.image, failures[i])) return;
    bool ones = false;
    if (options.masks == MaskPolicy::kAuto && source.plate.empty())
      origins[i] = take_given_mask(source, loader, view, ones);
    of_ones += ones;
    make_opaque(view.image);
  });

  leave_out_unreadable(failures, options.strict, scene, origins, result);
  count = scene.views.size();
  if (of_ones > 0)
    result.warnings.push_back(concat(of_ones, of_ones == 1 ? " mask has" : " masks have",
                                     " no other values than 0 and 1: 1 was taken for the object "
                                     "(255)"));
  check_masks(result);
  result.masks.resize(count);
  if (use_masks) find(scene, loader, options.cut_masks, origins, result);
  describe_masks(origins, result);

  progress.check_cancelled();
  for_each_view(count, kDecodeShare, 1.0, progress, [&](std::size_t i) {
    PreparedView& view = result.views[i];
    view.source = scene.views[i];
    undistort(view.source.distortion, options.max_frame_growth, view);
  });
  return result;
}

}  // namespace photohull

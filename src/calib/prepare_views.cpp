#include "calib/prepare_views.h"

#include <tbb/parallel_for.h>

#include <mutex>

#include "calib/masks.h"
#include "core/error.h"

namespace photohull {
namespace {

/// Counts finished views; Progress itself need not be thread-safe.
class Counter {
 public:
  Counter(Progress& progress, std::size_t total) : progress_(progress), total_(total) {}
  void count_one() {
    const std::scoped_lock lock(mutex_);
    progress_.update(double(++done_) / double(total_));
  }

 private:
  Progress& progress_;
  std::size_t total_;
  std::size_t done_ = 0;
  std::mutex mutex_;
};

ColourImage load_image(const SourceView& source, const ViewLoader& loader) {
  ColourImage image = loader.image(source.image);
  const Intrinsics& k = source.camera.intrinsics;
  if (image.width != k.width || image.height != k.height)
    throw Error(concat(source.image.string(), ": the picture has ", image.width, "x", image.height,
                       " pixels but its camera is for ", k.width, "x", k.height,
                       "; use the pictures that were calibrated"));
  return image;
}

}  // namespace

void PrepareOptions::validate() const {
  if (!(max_frame_growth >= 1.0 && max_frame_growth <= 8.0))
    throw UsageError(concat("max_frame_growth must lie in [1, 8], not ", max_frame_growth));
}

PreparedViews prepare_views(const Scene& scene, const ViewLoader& loader,
                            const PrepareOptions& options, Progress& progress) {
  options.validate();
  if (scene.views.empty()) throw Error(concat(scene.path.string(), ": lists no pictures"));
  PreparedViews result;
  result.views.resize(scene.views.size());
  std::vector<MaskOrigin> origins(scene.views.size(), MaskOrigin::kNone);
  Counter counter(progress, scene.views.size());
  tbb::parallel_for(std::size_t(0), scene.views.size(), [&](std::size_t i) {
    progress.check_cancelled();
    const SourceView& source = scene.views[i];
    View& view = result.views[i];
    view.name = source.name;
    view.camera = source.camera;
    view.image = load_image(source, loader);
    if (options.masks == MaskPolicy::kAuto) origins[i] = take_given_mask(source, loader, view);
    make_opaque(view.image);
    counter.count_one();
  });
  describe_masks(origins, 0.0, result);
  check_masks(result);
  return result;
}

}  // namespace photohull

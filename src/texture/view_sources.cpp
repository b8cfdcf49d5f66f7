#include "texture/view_sources.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace photohull::texture {

ViewSources::ViewSources(const TriMesh& mesh, std::span<const PreparedView> views, double scale,
                         std::int64_t bytes)
    : mesh_(mesh), views_(views), scale_(scale), made_(views.size()), sources_(views.size()) {
  std::int64_t largest = 0;
  for (const PreparedView& view : views) largest = std::max(largest, source_bytes(view, scale));
  for (; kept_ < views.size(); ++kept_) {
    const std::int64_t more = source_bytes(views[kept_], scale);
    if (bytes_ + more > bytes) break;
    bytes_ += more;
  }
  bytes_ += std::min<std::int64_t>(kSourcesAtOnce, views.size() - kept_) * largest;
}

std::shared_ptr<const ViewSource> ViewSources::get(std::size_t view) {
  const auto make = [&] { return std::make_shared<const ViewSource>(mesh_, views_[view], scale_); };
  if (view >= kept_) return make();
  std::call_once(made_[view], [&] { sources_[view] = make(); });
  return sources_[view];
}

std::int64_t source_bytes(const PreparedView& view, double scale) {
  const Intrinsics k = scaled_camera(view, scale).intrinsics;
  return std::int64_t(k.width) * k.height * (scale < 1 ? kMapBytes + 8 : kMapBytes);
}

void for_views(std::size_t count, const std::function<void(std::size_t)>& f) {
  tbb::task_arena arena(std::min(tbb::this_task_arena::max_concurrency(), kSourcesAtOnce));
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i < range.end(); ++i) f(i);
        },
        tbb::simple_partitioner());
  });
}

}  // namespace photohull::texture

// Private to module texture: photographs with what they show of the mesh, as many at a time as
// memory bears.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "core/mesh.h"
#include "core/prepared_view.h"
#include "texture/projection.h"
#include "texture/view_maps.h"
#include "texture/view_pixels.h"

namespace photohull::texture {

/// A photograph at the texture's scale. It refers to the view.
struct ViewSource {
  ViewSource(const TriMesh& mesh, const PreparedView& view, double scale)
      : pixels(view, scale), maps(mesh, pixels), projector(pixels.camera(), mesh.origin) {}

  ViewPixels pixels;
  ViewMaps maps;
  Projector projector;  ///< into its pixels
};

/// Sources that are made at the same time, each by a thread.
inline constexpr int kSourcesAtOnce = 4;
inline constexpr int kMapBytes = 5;  ///< of a source's pixel, beside its colour

/// That a source takes.
std::int64_t source_bytes(const PreparedView& view, double scale);

/// Sources of all views. The first of them are kept once they were asked for, as far as `bytes`
/// reach; others are made each time. It refers to mesh and views.
class ViewSources {
 public:
  ViewSources(const TriMesh& mesh, std::span<const PreparedView> views, double scale,
              std::int64_t bytes);

  std::size_t size() const { return views_.size(); }
  /// That the sources take at most which are kept or made at the same time.
  std::int64_t bytes() const { return bytes_; }
  /// From any thread.
  std::shared_ptr<const ViewSource> get(std::size_t view);

 private:
  const TriMesh& mesh_;
  std::span<const PreparedView> views_;
  double scale_;
  std::size_t kept_ = 0;  // of the first views
  std::int64_t bytes_ = 0;
  std::vector<std::once_flag> made_;
  std::vector<std::shared_ptr<const ViewSource>> sources_;
};

/// Calls `f(i)` for each view, in parallel, but few at a time: each holds maps of its photograph.
void for_views(std::size_t count, const std::function<void(std::size_t)>& f);

}  // namespace photohull::texture

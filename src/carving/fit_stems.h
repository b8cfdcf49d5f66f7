// Stems as thin as the masks say they are.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/describe.h"
#include "core/image.h"
#include "core/mesh.h"
#include "core/silhouette.h"

namespace photohull::carving {

/// A view's mask as it was given, and its lines; nullptr both where there is no mask.
struct StemView {
  Camera camera;
  const Mask* mask = nullptr;
  const std::vector<LinePoint>* lines = nullptr;
};

struct StemOptions {
  double least_share = 1.0 / 3;
  int least_views = 3;
};

inline void describe(Described& to, StemOptions& o) {
  to.affects(Stage::kMesh);
  to.number(
      "least_share", &o.least_share, at_least(0), "",
      "share of the views that see a place in which it must fall beside a line; above 1: nothing "
      "is a stem");
  to.number("least_views", &o.least_views, at_least(1), "",
            "views in which a place must fall beside a line");
}

/// Moves the vertices of parts that show as lines in so many views to where these lines say: the
/// middle of a stem is the point nearest to the planes through the cameras and the lines, in
/// pixels; its radius follows from the integral of the coverage across it, a mean over all views in
/// which nothing else stands beside it. Sheets that show on edge in so many views move along their
/// one known direction. `voxel_size` (world units) is how far off vertices may be. Faces, and with
/// them what is connected, stay. Returns the number of vertices that moved; normals are not
/// touched.
std::size_t fit_stems(std::span<const StemView> views, double voxel_size, TriMesh& mesh,
                      const StemOptions& options = {});

}  // namespace photohull::carving

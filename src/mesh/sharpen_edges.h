// Sharp edges that reconstruction rounds off.
#pragma once

#include <cstddef>

#include "core/describe.h"
#include "core/mesh.h"

namespace photohull {

/// Lengths are in units of the surface's detail, see sharpen_edges.
struct SharpenOptions {
  bool on = true;
  double bend = 0.15, reach = 10, distinct = 25, rounding = 3, shortest = 16;

  /// Throws UsageError naming the option.
  void validate() const;
};

inline void describe(Described& to, SharpenOptions& o) {
  to.affects(Stage::kMesh);
  to.flag("", &o.on, "make edges sharp that refinement rounds");
  to.number("bend", &o.bend, above(0), "radians",
            "turn of the normals over a length from which surface may be a rounded edge");
  to.number("reach", &o.reach, from_to(3, 30), "lengths",
            "distance from a vertex within which the flanks of an edge are fitted");
  to.number("distinct", &o.distinct, at_least(0), "",
            "least turn between flanks over the flanks' own roughness");
  to.number("rounding", &o.rounding, at_least(0), "lengths",
            "largest radius by which an edge may be rounded");
  to.number("shortest", &o.shortest, at_least(0), "lengths", "least length of an edge");
}

inline void SharpenOptions::validate() const { check_described(*this); }

/// Makes edges and corners of an extracted surface sharp where the smooth surfaces on either side,
/// fitted beside the edge and extended, meet near it, and where that shows along the whole edge
/// against the roughness of these surfaces. Vertices near an edge move onto the extended surfaces
/// or, where they part the triangles of two or three, onto the line or the point where these meet
/// [Kobbelt01; Ju02]; edges of triangles follow the line. Triangles stay the same, and what would
/// fold or degenerate stays in its place. Real roundings of radii up to about `rounding` become
/// sharp too: an extracted surface does not tell them from sharp edges.
///
/// `voxel_size` is that of the volume that `mesh` was extracted from, and `detail` the length of
/// what the surface resolves, not less: both in world units, > 0. Needs normals; moved vertices get
/// new ones. Returns how many vertices moved. The same mesh gives the same result with any number
/// of threads.
std::size_t sharpen_edges(const SharpenOptions& options, double voxel_size, double detail,
                          TriMesh& mesh);

}  // namespace photohull

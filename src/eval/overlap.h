// How much of two bodies' volume is common.
#pragma once

#include <cstddef>
#include <string>

#include "core/mesh.h"

namespace photohull::eval {

struct Closedness {
  std::size_t edges = 0;       ///< between different positions
  std::size_t open_edges = 0;  ///< without a counterpart in the other direction

  bool closed() const { return edges > 0 && open_edges == 0; }
};

/// A mesh is closed when every edge is run through as often in one direction as in the other;
/// vertices at the same position count as one. Only then does it say everywhere how often it
/// winds around a point.
Closedness check_closed(const TriMesh& mesh);

struct Overlap {
  bool known = false;
  std::string reason;                     ///< why it is not known
  double first = 0, second = 0;           ///< volumes, world units cubed
  double intersection = 0, together = 0;  ///< of both, of either
  double iou = 0;                         ///< intersection / together
};

/// Volumes of two closed meshes and of what they share. Lines along z through the centres of the
/// cells of a square grid, `columns` of them along the longer side of both meshes' box, are cut
/// with all triangles; what the winding number calls inside counts with its exact length. A line
/// through an edge or a corner is moved aside by an infinitesimal step [EdelsbrunnerMuecke90], so
/// that it meets each closed surface a consistent number of times. `columns` in [1, 4096].
Overlap measure_overlap(const TriMesh& first, const TriMesh& second, int columns);

}  // namespace photohull::eval

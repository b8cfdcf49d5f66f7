// Fewer triangles for the same surface.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <vector>

#include "core/mesh.h"

namespace photohull {

/// Distances between two surfaces, in both directions, world units.
struct MeshDistance {
  double mean = 0;
  double p95 = 0, p999 = 0;  ///< 95 and 99.9 of 100 points are nearer
  double max = 0;
};

/// Measures from the vertices and from points of the faces of each mesh, at most `spacing` apart
/// (world units, > 0), to the nearest point of the other. Both meshes need triangles.
MeshDistance measure_distance(const TriMesh& first, const TriMesh& second, double spacing);

/// Mean length of the triangles' edges, world units; 0 without triangles.
double mean_edge(const TriMesh& mesh);

/// Merges vertices while both surfaces stay within `error` (world units) of each other: no point
/// of the one is farther from the other, as measured at points about a mean edge of `mesh` apart.
/// Where flat, few triangles are left.
///
/// The vertices of the result are some of the mesh's, in their order, with all their attributes,
/// and moved by `error` at most to where the mean square distance between the surfaces is small.
/// A mesh that is closed and manifold stays so; the border of an open one keeps all its vertices in
/// their places. No new triangle is folded onto its neighbour or degenerate. Edges collapse by
/// quadrics [GarlandHeckbert97] in meshoptimizer; then edges are flipped and vertices moved by
/// least squares [Hoppe93]. What fails a check keeps the triangles of `mesh`, or the places of its
/// vertices, in its surroundings. The same mesh gives the same result with any number of threads.
///
/// `error` must be finite and not negative, else UsageError; 0 gives the mesh as it is, and so does
/// a mesh without triangles.
TriMesh simplify_mesh(const TriMesh& mesh, double error);

/// Lists of numbers beside a mesh's attributes, one for each vertex.
using MoreNumbers = std::initializer_list<std::vector<float>*>;

/// Drops vertices that no triangle uses, with their attributes; each list of `more` loses the
/// numbers of the dropped ones.
void keep_used_vertices(TriMesh& mesh, MoreNumbers more = {});

}  // namespace photohull

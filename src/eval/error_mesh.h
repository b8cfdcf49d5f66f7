// Where a reconstruction is off, in colours.
#pragma once

#include <vector>

#include "core/atomic_file.h"
#include "core/mesh.h"
#include "core/progress.h"
#include "eval/signed_distance.h"

namespace photohull::eval {

/// Colour of a signed distance, 8-bit sRGB values in [0, 255]: white at 0, through orange to dark
/// red at `range` and beyond (outside the truth), through light to dark blue at -range and beyond.
glm::dvec3 error_colour(double distance, double range);

/// Signed distance from each vertex of `result` to the truth, world units, positive outside.
std::vector<double> vertex_distances(const TriMesh& result, const SignedDistance& truth,
                                     Progress& progress);

/// Writes `result` as a PLY whose vertices have error_colour as colour and their distance as the
/// property `distance`; the caller commits. Throws Error when it cannot be written, and Cancelled.
void write_error_mesh(AtomicFile& file, const TriMesh& result, const SignedDistance& truth,
                      double range, Progress& progress);

}  // namespace photohull::eval

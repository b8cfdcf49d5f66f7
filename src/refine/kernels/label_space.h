// Which space is solid, from evidence that does not say so everywhere.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/describe.h"
#include "gpu/context.h"

namespace photohull::refine {

struct LabelOptions {
  double evidence = 24, unknown = 0.02;
  int iterations = 150;
};

/// What the usual claim of the rays is depends on how many views there are and how sure they are,
/// so that few views are believed as well.
inline void describe(Described& to, LabelOptions& o) {
  to.number("evidence", &o.evidence, above(0, 1000), "",
            "faces of surface that the usual claim of the rays on a voxel outweighs");
  to.number("unknown", &o.unknown, from_to(0, 1000), "",
            "cost of a solid voxel that no ray says anything of");
  to.number("iterations", &o.iterations, from_to(0, 10000), "",
            "iterations of the labelling; 0: unknown space is solid");
}

/// The labels u, 1 solid and 0 free, of the voxels of bricks (8^3 each, x slowest) that minimise
/// the surface's area plus the sum of `evidence` over what is solid:
///
///   min over u in [0, 1] of  sum |grad u| + sum evidence u
///
/// in voxels, by the primal-dual method [Chambolle11]. The problem is convex, and thresholding u
/// anywhere gives a smallest cut [Chan06], so that 0.5 does. Evidence is positive where space is
/// free, negative where it is solid; where it is 0 the surface with the smallest area decides. At
/// the border of the bricks nothing is cut. `bricks` are distinct. Throws Error when the device
/// cannot hold them.
std::vector<float> label_space(gpu::Context& context, std::span<const glm::ivec3> bricks,
                               std::span<const float> evidence, int iterations);

/// For each brick those beside it along +x, +y, +z, -x, -y, -z: indices, -1 where there is none.
std::vector<int> neighbours_of(std::span<const glm::ivec3> bricks);

namespace reference {

/// The same in double precision, voxel by voxel.
std::vector<double> label_space(std::span<const glm::ivec3> bricks, std::span<const float> evidence,
                                int iterations);

}  // namespace reference
}  // namespace photohull::refine

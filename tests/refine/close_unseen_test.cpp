#include "refine/close_unseen.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "support/analytic_volumes.h"
#include "volume/distance_from_mesh.h"
#include "volume/extract_mesh.h"

namespace photohull::refine {
namespace {

using glm::dvec3;

/// Is a vertex seen? Position in voxels, unit normal.
using Seen = std::function<bool(const dvec3& at, const dvec3& normal)>;

/// Closes the unseen surface of a volume as the refinement does, step by step.
SparseVolume close(SparseVolume volume, const Seen& sees, int steps,
                   const CloseOptions& options = {}) {
  for (int i = 0; i < steps; ++i) {
    const TriMesh mesh = extract_mesh(volume);
    std::vector<bool> seen;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      seen.push_back(sees((mesh.world(v) - volume.grid.origin) / volume.grid.voxel_size,
                          dvec3(mesh.normals[v])));
    const std::vector<float> moves =
        close_unseen(volume.grid, mesh, make_graph(mesh), seen, options);
    EXPECT_EQ(moves.size(), seen.size());
    for (std::size_t v = 0; v < moves.size(); ++v) {
      if (seen[v]) {
        EXPECT_EQ(moves[v], 0);
      }
      EXPECT_LE(std::abs(moves[v]), options.longest);
    }
    move_surface(volume, mesh, moves);
    volume = distance_from_mesh(extract_mesh(volume), volume, volume.grid);
  }
  return volume;
}

/// Where the body begins, going up a column of voxels.
double lowest(const SparseVolume& volume, int x, int y) {
  for (int z = 1; z < volume.grid.voxels().z; ++z) {
    const double below = volume.at({x, y, z - 1}), here = volume.at({x, y, z});
    if (here < 0) return z - here / (here - below);
  }
  return volume.grid.voxels().z;
}

/// A box from z = 20 upwards with a pyramid of 45 degrees hanging from it.
double bulging_box(const dvec3& p) {
  const double slope = (std::abs(p.x - 24) + std::abs(p.y - 24) + (20 - p.z) - 14) / std::sqrt(3.0);
  return std::min(box({8, 8, 20}, {40, 40, 40})(p), std::max(slope, p.z - 25));
}

bool not_below(const dvec3& at, const dvec3&) { return at.z > 19.3; }

TEST(CloseUnseen, BulgeBelowABoxIsClosedFlat) {
  const SparseVolume before = sample_volume({6, 6, 6}, bulging_box, {1, 2, 3}, 0.5);
  ASSERT_LT(lowest(before, 24, 24), 8);
  const SparseVolume after = close(before, not_below, 12);
  for (int x = 12; x <= 36; x += 3)
    for (int y = 12; y <= 36; y += 3) EXPECT_NEAR(lowest(after, x, y), 20, 1.0) << x << ' ' << y;
  EXPECT_NEAR(double(after.inside_voxels()), 32 * 32 * 20, 0.06 * 32 * 32 * 20);
}

TEST(CloseUnseen, NothingMovesWhereAllIsSeen) {
  const SparseVolume volume = sample_volume({4, 4, 4}, sphere(dvec3(15.5), 10));
  const TriMesh mesh = extract_mesh(volume);
  const VertexGraph graph = make_graph(mesh);
  const std::size_t n = mesh.positions.size();
  for (const float move : close_unseen(volume.grid, mesh, graph, std::vector<bool>(n, true), {}))
    EXPECT_EQ(move, 0);
}

TEST(CloseUnseen, NarrowPatchesStay) {
  const SparseVolume volume = sample_volume({4, 4, 4}, sphere(dvec3(15.5), 10));
  const TriMesh mesh = extract_mesh(volume);
  const VertexGraph graph = make_graph(mesh);
  const auto moved = [&](double width) {
    std::vector<bool> seen;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
      seen.push_back(std::hypot(mesh.world(i).x - 15.5, mesh.world(i).y - 15.5) > width ||
                     mesh.world(i).z > 15);
    const auto moves = close_unseen(volume.grid, mesh, graph, seen, {});
    return std::count_if(moves.begin(), moves.end(), [](float d) { return d != 0; });
  };
  EXPECT_EQ(moved(1.5), 0);
  EXPECT_GT(moved(6), 50);
}

TEST(CloseUnseen, AWallStaysBehindAPlateSeenFromOneSide) {
  // The edges and the back of a plate: a membrane over the rim of its front would leave nothing.
  const SparseVolume plate = sample_volume({6, 6, 4}, box({8, 8, 12}, {40, 40, 19}));
  const Seen from_above = [](const dvec3&, const dvec3& n) { return n.z > 0.5; };
  const SparseVolume kept = close(plate, from_above, 8);
  CloseOptions none;
  none.thickness = 0;
  const SparseVolume lost = close(plate, from_above, 8, none);
  for (int x = 16; x <= 32; x += 4)
    for (int y = 16; y <= 32; y += 4) {
      const double thickness = 19 - lowest(kept, x, y);
      EXPECT_GT(thickness, 1.2);
      EXPECT_LT(thickness, 3.5);
      EXPECT_LT(19 - lowest(lost, x, y), thickness - 0.5);
    }
}

TEST(CloseUnseen, EmptyMesh) {
  EXPECT_TRUE(close_unseen({dvec3(0), 1, {1, 1, 1}}, {}, make_graph({}), {}, {}).empty());
}

}  // namespace
}  // namespace photohull::refine

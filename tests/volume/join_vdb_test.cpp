#include "volume/join_vdb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <vector>

#include "core/error.h"
#include "painted.h"
#include "support/analytic_volumes.h"
#include "support/scratch_folder.h"

namespace photohull {
namespace {

namespace fs = std::filesystem;
using glm::ivec3;
using testing::HasSubstr;

constexpr double kVoxelSize = 0.25;
const ivec3 kBricks(6, 7, 8);

/// Colours of a voxel's brick, and a confidence of every other one.
VolumeAttributes paint(const SparseVolume& volume, const ivec3& first) {
  return painted(
      volume,
      [&](std::size_t i) { return glm::vec3(volume.bricks[i / kBrickVoxels] + first) / 8.0f; },
      [](std::size_t i) { return i % 2 ? 0.75f : VolumeAttributes::kUnknown; });
}

class JoinVdb : public testing::Test {
 protected:
  /// Bricks from `first` up to `end` of a body with a large inside, on a grid of their own.
  fs::path part(const std::string& name, const ivec3& first, const ivec3& end,
                double voxel_size = kVoxelSize, const glm::dvec3& off = glm::dvec3(0)) {
    const glm::dvec3 shift = glm::dvec3(first * kBrickEdge);
    const SparseVolume volume = sample_volume(
        end - first, [&](const glm::dvec3& p) { return body(p + shift); },
        glm::dvec3(10, -20, 30) + voxel_size * (shift + off), voxel_size);
    write_vdb(folder_ / name, volume, paint(volume, first), {});
    return folder_ / name;
  }

  std::string bytes_of(const fs::path& file) const {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  fs::path joined(const std::vector<fs::path>& parts, const std::string& name = "joined.vdb") {
    AtomicFile file(folder_ / name);
    join_vdb(file, parts, {{"photohull_options", "x"}});
    file.commit();
    return folder_ / name;
  }

  Distance body = sphere({24.3, 27.6, 31.2}, 22);
  ScratchFolder folder_;
};

TEST_F(JoinVdb, PartsBecomeTheWhole) {
  const std::vector<fs::path> parts = {part("a.vdb", {0, 0, 0}, {6, 3, 8}),
                                       part("b.vdb", {0, 3, 0}, {4, 7, 8}),
                                       part("c.vdb", {4, 3, 0}, {6, 7, 8})};
  const fs::path whole = part("whole.vdb", {0, 0, 0}, kBricks);
  const fs::path file = joined(parts);
  const SparseVolume expected = read_vdb_surface(whole), found = read_vdb_surface(file);
  ASSERT_EQ(found.grid.bricks, expected.grid.bricks);
  EXPECT_LT(glm::distance(found.grid.origin, expected.grid.origin), 1e-9);
  std::size_t inside = 0;
  for (int x = 0; x < found.grid.voxels().x; ++x)
    for (int y = 0; y < found.grid.voxels().y; ++y)
      for (int z = 0; z < found.grid.voxels().z; ++z) {
        ASSERT_EQ(found.at({x, y, z}), expected.at({x, y, z})) << x << ' ' << y << ' ' << z;
        inside += found.at({x, y, z}) < 0;
      }
  EXPECT_EQ(inside, expected.inside_voxels());
  openvdb::io::File in(file.string()), of_whole(whole.string());
  in.open(false), of_whole.open(false);
  for (const char* name : {"Cd", "confidence"}) {
    const auto grid = in.readGrid(name), usual = of_whole.readGrid(name);
    EXPECT_EQ(grid->activeVoxelCount(), usual->activeVoxelCount()) << name;
    EXPECT_EQ(grid->saveFloatAsHalf(), usual->saveFloatAsHalf());
    EXPECT_EQ(grid->evalActiveVoxelBoundingBox(), usual->evalActiveVoxelBoundingBox());
  }
  const auto colours = openvdb::gridPtrCast<openvdb::Vec3fGrid>(in.readGrid("Cd"));
  for (auto at = colours->cbeginValueOn(); at; ++at)
    for (int a = 0; a < 3; ++a) ASSERT_EQ((*at)[a], float(at.getCoord()[a] / kBrickEdge) / 8);
  EXPECT_GT(joined_bytes(parts), 100000u);
}

TEST_F(JoinVdb, AnyOrderHasTheSameVoxelsAndEqualFilesEqualBytes) {
  const fs::path a = part("a.vdb", {0, 0, 0}, {6, 7, 3}), b = part("b.vdb", {0, 0, 3}, kBricks);
  const std::vector<fs::path> one = {a, b}, other = {b, a};
  EXPECT_EQ(bytes_of(joined(one, "1.vdb")), bytes_of(joined(one, "2.vdb")));
  const SparseVolume first = read_vdb_surface(folder_ / "1.vdb"),
                     second = read_vdb_surface(joined(other, "3.vdb"));
  EXPECT_EQ(first.table, second.table);
  EXPECT_EQ(first.distance, second.distance);
  EXPECT_LT(glm::distance(joined_grid(other).origin, joined_grid(one).origin), 1e-9);
}

TEST_F(JoinVdb, OfBricksThatTwoHaveTheFirstIsTaken) {
  const fs::path a = part("a.vdb", {0, 0, 0}, {6, 7, 5});
  body = sphere({24.3, 27.6, 31.2}, 20);
  const fs::path b = part("b.vdb", {0, 0, 3}, kBricks);
  const SparseVolume found = read_vdb_surface(joined({{a, b}}));
  EXPECT_LT(found.at({24 + 21, 28, 31}), 0) << "in the bricks of both";
  EXPECT_GT(found.at({24, 28, 31 + 21}), 0) << "in those of the second alone";
}

TEST_F(JoinVdb, SpecksThatOnePartAloneHasAtItsBorderGo) {
  const Distance ball = sphere({24.3, 27.6, 31.2}, 14);
  const auto with = [&](const glm::dvec3& centre, double radius) -> Distance {
    return [=](const glm::dvec3& p) { return std::min(ball(p), sphere(centre, radius)(p)); };
  };
  const auto inside = [&](const Distance& first, const Distance& second) {
    body = first;
    const fs::path a = part("a.vdb", {0, 0, 0}, {6, 3, 8});
    body = second;
    const fs::path b = part("b.vdb", {0, 3, 0}, kBricks);
    return read_vdb_surface(joined({a, b})).inside_voxels();
  };
  const std::size_t alone = inside(ball, ball);
  const Distance at_border = with({6, 23.5, 6}, 2), within = with({6, 14, 6}, 2),
                 large = with({6, 23.5, 6}, 5);
  EXPECT_EQ(inside(at_border, ball), alone);
  EXPECT_EQ(inside(ball, at_border), alone);
  EXPECT_GT(inside(at_border, at_border), alone) << "both have it";
  EXPECT_GT(inside(within, ball), alone) << "it is no matter of the border";
  EXPECT_GT(inside(large, ball), alone + 100) << "it is no speck";
  EXPECT_GT(inside(with({0, 14, 6}, 2), ball), alone) << "the box cuts it, and no part";
}

TEST_F(JoinVdb, OtherVoxelsAreRefusedByName) {
  const fs::path a = part("a.vdb", {0, 0, 0}, {6, 7, 3});
  const auto refusal = [&](const fs::path& other) {
    try {
      joined({a, other});
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("nothing was refused");
  };
  EXPECT_THAT(refusal(part("size.vdb", {0, 0, 3}, kBricks, 2 * kVoxelSize)),
              testing::AllOf(HasSubstr("size.vdb"), HasSubstr("not those of the other parts")));
  EXPECT_THAT(refusal(part("off.vdb", {0, 0, 3}, kBricks, kVoxelSize, {0.5, 0, 0})),
              HasSubstr("off.vdb"));
  EXPECT_THAT(refusal(folder_ / "none.vdb"), HasSubstr("none.vdb"));
  std::ofstream(folder_ / "text.vdb") << "no volume";
  EXPECT_THAT(refusal(folder_ / "text.vdb"), HasSubstr("text.vdb"));
  EXPECT_FALSE(fs::exists(folder_ / "joined.vdb"));
}

}  // namespace
}  // namespace photohull

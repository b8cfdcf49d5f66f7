#include "volume/write_vdb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <cstdio>

#include "core/error.h"
#include "painted.h"
#include "support/analytic_volumes.h"
#include "support/scratch_folder.h"

namespace photohull {
namespace {

using testing::HasSubstr;

constexpr double kVoxelSize = 0.25;
const glm::dvec3 kOrigin(10, -20, 30);

SparseVolume ball() {
  return sample_volume({6, 5, 7}, sphere({22, 19, 25}, 15), kOrigin, kVoxelSize);
}

VolumeAttributes paint(const SparseVolume& volume) {
  return painted(
      volume, [](std::size_t i) { return glm::vec3(0.25f, float(i % 100) / 100, 0.5f); },
      [](std::size_t i) { return i % 2 ? 0.75f : VolumeAttributes::kUnknown; });
}

std::string print(const std::string& arguments) {
  std::string text;
  FILE* pipe = ::popen((std::string(VDB_PRINT) + " " + arguments + " 2>&1").c_str(), "r");
  for (int c; pipe && (c = std::fgetc(pipe)) != EOF;) text += char(c);
  return pipe && ::pclose(pipe) == 0 ? text : "failed: " + text;
}

class WriteVdb : public testing::Test {
 protected:
  void SetUp() override {
    openvdb::initialize();
    write_vdb(folder_ / "a.vdb", volume_, attributes_, {{"options", "--voxel 0.25"}});
    file_ = std::make_unique<openvdb::io::File>((folder_ / "a.vdb").string());
    file_->open(false);
  }
  template <typename Grid>
  typename Grid::Ptr read(const char* name) {
    return openvdb::gridPtrCast<Grid>(file_->readGrid(name));
  }

  ScratchFolder folder_;
  SparseVolume volume_ = ball();
  VolumeAttributes attributes_ = paint(volume_);
  std::unique_ptr<openvdb::io::File> file_;
};

TEST_F(WriteVdb, SurfaceIsALevelSetInWorldUnits) {
  const auto grid = read<openvdb::FloatGrid>("surface");
  EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
  EXPECT_FLOAT_EQ(grid->background(), 3 * kVoxelSize);
  EXPECT_EQ(grid->getCreator(), "created by photohull 0.1.0");
  const openvdb::Vec3d world = grid->indexToWorld(openvdb::Coord(3, 5, 7));
  const glm::dvec3 expected = volume_.grid.world({3, 5, 7});
  EXPECT_EQ(world, openvdb::Vec3d(expected.x, expected.y, expected.z));
  const glm::ivec3 size = volume_.grid.voxels();
  for (int x = -1; x <= size.x; ++x)
    for (int y = -1; y <= size.y; ++y)
      for (int z = -1; z <= size.z; ++z) {
        const float distance = volume_.at({x, y, z});
        const openvdb::Coord at(x, y, z);
        ASSERT_FLOAT_EQ(grid->tree().getValue(at), distance * kVoxelSize);
        ASSERT_EQ(grid->tree().isValueOn(at), std::abs(distance) < 3);
      }
}

TEST_F(WriteVdb, AttributesAreWhereTheyAreKnownNearTheSurface) {
  const auto colour = read<openvdb::Vec3fGrid>("Cd");
  const auto confidence = read<openvdb::FloatGrid>("confidence");
  EXPECT_EQ(colour->getVectorType(), openvdb::VEC_INVARIANT);
  EXPECT_TRUE(colour->saveFloatAsHalf() && confidence->saveFloatAsHalf());
  EXPECT_EQ(confidence->getGridClass(), openvdb::GRID_UNKNOWN);
  EXPECT_EQ(colour->transform(), read<openvdb::FloatGrid>("surface")->transform());
  for (std::size_t slot = 0; slot < volume_.bricks.size(); ++slot)
    for (int i = 0; i < kBrickVoxels; ++i) {
      const std::size_t index = slot * kBrickVoxels + i;
      const glm::ivec3 v =
          volume_.bricks[slot] * kBrickEdge + glm::ivec3(i >> 6, (i >> 3) & 7, i & 7);
      const openvdb::Coord at(v.x, v.y, v.z);
      const bool near = std::abs(volume_.distance[index]) < VolumeAttributes::kReach;
      ASSERT_EQ(colour->tree().isValueOn(at), near);
      ASSERT_EQ(confidence->tree().isValueOn(at), near && index % 2);
      if (!near) continue;
      ASSERT_NEAR(colour->tree().getValue(at).y(), attributes_.colour[index].g, 1e-3);
      if (index % 2) {
        ASSERT_EQ(confidence->tree().getValue(at), 0.75f);
      }
    }
}

TEST_F(WriteVdb, MetadataIsInTheFileAndEveryGrid) {
  const auto meta = file_->getMetadata();
  EXPECT_EQ(meta->metaValue<std::string>("options"), "--voxel 0.25");
  EXPECT_EQ(meta->metaValue<double>("voxel_size"), kVoxelSize);
  for (const char* name : {"surface", "Cd", "confidence"}) {
    const auto grid = file_->readGridMetadata(name);
    EXPECT_EQ(grid->metaValue<std::string>("options"), "--voxel 0.25");
    EXPECT_EQ(grid->metaValue<std::string>("photohull_version"), "0.1.0");
  }
}

TEST_F(WriteVdb, OtherProgramsReadIt) {
  const std::string text = print("-l -m " + (folder_ / "a.vdb").string());
  for (const char* part : {"surface", "Cd", "confidence", "level set", "options: --voxel 0.25",
                           "created by photohull", "voxel size: 0.25"})
    EXPECT_THAT(text, HasSubstr(part));
}

TEST_F(WriteVdb, ComesBackAsItWas) {
  const SparseVolume back = read_vdb_surface(folder_ / "a.vdb");
  EXPECT_EQ(back.grid.bricks, volume_.grid.bricks);
  EXPECT_EQ(back.grid.origin, volume_.grid.origin);
  EXPECT_EQ(back.grid.voxel_size, volume_.grid.voxel_size);
  ASSERT_EQ(back.bricks.size(), volume_.bricks.size());
  EXPECT_EQ(back.table, volume_.table);
  for (std::size_t i = 0; i < back.distance.size(); ++i)
    ASSERT_FLOAT_EQ(back.distance[i], volume_.distance[i]);
}

// OpenVDB takes voxels of such a size for nothing.
TEST_F(WriteVdb, TinyScenesComeBackToo) {
  SparseVolume tiny = volume_;
  tiny.grid.voxel_size *= 1e-8;
  tiny.grid.origin *= 1e-8;
  write_vdb(folder_ / "tiny.vdb", tiny, {}, {});
  const SparseVolume back = read_vdb_surface(folder_ / "tiny.vdb");
  EXPECT_NEAR(back.grid.voxel_size / tiny.grid.voxel_size, 1, 1e-12);
  EXPECT_LT(glm::distance(back.grid.origin, tiny.grid.origin), 1e-9 * tiny.grid.voxel_size);
  for (std::size_t i = 0; i < back.distance.size(); ++i)
    ASSERT_FLOAT_EQ(back.distance[i], tiny.distance[i]);
  EXPECT_EQ(vdb_unit(1e-3), 1);
  EXPECT_EQ(vdb_unit(3e5), 1);
}

TEST_F(WriteVdb, SurfaceAloneAndNothingAtAll) {
  write_vdb(folder_ / "b.vdb", volume_, {}, {{"voxel_size", "text that gives way"}});
  openvdb::io::File file((folder_ / "b.vdb").string());
  file.open(false);
  EXPECT_EQ(file.getGrids()->size(), 1u);
  const SparseVolume nothing = sample_volume({2, 3, 4}, [](const glm::dvec3&) { return 9.0; });
  write_vdb(folder_ / "c.vdb", nothing, {}, {});
  EXPECT_EQ(read_vdb_surface(folder_ / "c.vdb").table, nothing.table);
}

TEST_F(WriteVdb, FullDiskIsAnErrorAndKeepsTheOldFile) {
  const std::string before = read_text(folder_ / "a.vdb");
  for (const rlim_t bytes : {0u, 100u, 5000u, 100000u}) {
    const FileSizeLimit limit(bytes);
    EXPECT_THROW(write_vdb(folder_ / "a.vdb", volume_, attributes_, {}), Error) << bytes;
  }
  EXPECT_EQ(read_text(folder_ / "a.vdb"), before);
  EXPECT_EQ(folder_.file_count(), 1u);
}

TEST_F(WriteVdb, ReadsForeignLevelSets) {
  auto grid = openvdb::FloatGrid::create(2.0f);
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  grid->setName("other");
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
  grid->tree().setValue(openvdb::Coord(-1, 3, 20), 0.25f);
  grid->tree().addTile(1, openvdb::Coord(0, 0, 16), -2.0f, false);
  grid->tree().setValue(openvdb::Coord(15, 0, 16), -0.25f);
  openvdb::io::File((folder_ / "f.vdb").string()).write({grid});
  const SparseVolume volume = read_vdb_surface(folder_ / "f.vdb");
  EXPECT_EQ(volume.grid.bricks, glm::ivec3(3, 1, 1));
  EXPECT_EQ(volume.grid.origin, glm::dvec3(-4, 0, 8));
  EXPECT_FLOAT_EQ(volume.at({7, 3, 4}), 0.5f);
  EXPECT_FLOAT_EQ(volume.at({23, 0, 0}), -0.5f);
  EXPECT_EQ(volume.at({8, 0, 0}), -SparseVolume::kBand);
}

TEST_F(WriteVdb, BadFilesAreErrors) {
  const auto error_of = [&](const char* name) -> std::string {
    try {
      read_vdb_surface(folder_ / name);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(error_of("none.vdb"), HasSubstr("none.vdb"));
  write_text(folder_ / "text.vdb", "this is no such file, though it is long enough");
  EXPECT_THAT(error_of("text.vdb"), HasSubstr("text.vdb"));
  write_text(folder_ / "cut.vdb", read_text(folder_ / "a.vdb").substr(0, 9000));
  EXPECT_THAT(error_of("cut.vdb"), HasSubstr("cut.vdb"));

  auto grid = openvdb::FloatGrid::create(1.0f);
  grid->setName("fog");
  openvdb::io::File((folder_ / "fog.vdb").string()).write({grid});
  EXPECT_THAT(error_of("fog.vdb"), HasSubstr("no level set"));
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  grid->transform().preScale(openvdb::Vec3d(1, 2, 1));
  openvdb::io::File((folder_ / "long.vdb").string()).write({grid});
  EXPECT_THAT(error_of("long.vdb"), HasSubstr("not axis-aligned cubes"));
  grid->setTransform(openvdb::math::Transform::createLinearTransform(1.0));
  grid->tree().setValue(openvdb::Coord(-1000000), 0.5f);
  grid->tree().setValue(openvdb::Coord(1000000), 0.5f);
  openvdb::io::File((folder_ / "wide.vdb").string()).write({grid});
  EXPECT_THAT(error_of("wide.vdb"), HasSubstr("clip the grid"));
}

}  // namespace
}  // namespace photohull

#include "eval/truth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/mesh/write_mesh.h"
#include "shapes.h"
#include "support/scratch_folder.h"

namespace photohull::eval {
namespace {

using testing::HasSubstr;

std::string error_of(const std::filesystem::path& path) {
  try {
    read_truth(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TriMesh two_points() {
  TriMesh points;
  points.positions = {{0, 0, 0}, {1, 1, 0}};
  return points;
}

TEST(ReadTruth, ScenesWithAndWithoutVisibility) {
  const ScratchFolder folder;
  write_ply(folder / "gt.ply", test::plate(0, 0, 0, 3, 2));
  const std::filesystem::path scene = (folder / "gt.ply").parent_path();
  Truth truth = read_truth(scene);
  EXPECT_FALSE(truth.has_views());
  EXPECT_THAT(truth.note, HasSubstr("no gt_visible.ply"));
  EXPECT_NEAR(truth.diagonal(), 3 * std::sqrt(2), 1e-6);
  write_ply(folder / "gt_visible.ply", two_points(), {{"views", {0, 300}}});
  truth = read_truth(scene);
  EXPECT_THAT(truth.views(), testing::ElementsAre(0, 255));
  EXPECT_NEAR(glm::distance(truth.samples()[1], {1, 1, 0}), 0, 1e-6);
  EXPECT_THAT(read_truth(folder / "gt.ply").note, HasSubstr("all surface counts"));
}

TEST(ReadTruth, FilesOfPointsAreTakenForPoints) {
  const ScratchFolder folder;
  TriMesh points = test::plate(0, 0, 0, 2, 4);
  points.triangles.clear();
  write_ply(folder / "scan.ply", points);
  const Truth truth = read_truth(folder / "scan.ply");
  EXPECT_TRUE(truth.is_points());
  EXPECT_DOUBLE_EQ(truth.spacing(), 0.5);
  EXPECT_DOUBLE_EQ(truth.distance({0, 0.5, -3}), 3);
  EXPECT_THAT(truth.note, HasSubstr("the nearest of 25 points, which are 0.5 apart"));
  write_ply(folder / "gt.ply", points);
  EXPECT_TRUE(read_truth((folder / "gt.ply").parent_path()).is_points());
  EXPECT_FALSE(Truth(test::plate(0, 0, 0, 2, 4)).is_points());
  TriMesh one;
  one.positions = {{0, 0, 0}};
  write_ply(folder / "gt.ply", one);
  EXPECT_THAT(error_of(folder / "gt.ply"), HasSubstr("neither faces nor points"));
}

TEST(ReadTruth, WhatIsMissingIsNamed) {
  const ScratchFolder folder;
  const std::filesystem::path scene = (folder / "x").parent_path();
  EXPECT_THAT(error_of(folder / "nothing"), HasSubstr("nothing"));
  EXPECT_THAT(error_of(scene), HasSubstr("has no gt.ply"));
  TriMesh flat = test::plate(0, 0, 0, 1, 1);
  flat.triangles = {{0, 1, 1}};
  write_ply(folder / "gt.ply", flat);
  EXPECT_THAT(error_of(scene), HasSubstr("no face of the mesh has an area"));
  flat.positions.assign(3, glm::vec3(0));
  flat.triangles = {{0, 1, 2}};
  write_ply(folder / "gt.ply", flat);
  EXPECT_THAT(error_of(scene), HasSubstr("gt.ply cannot be used"));
  write_ply(folder / "gt.ply", test::plate(0, 0, 0, 1, 1));
  write_ply(folder / "gt_visible.ply", two_points());
  EXPECT_THAT(error_of(scene), HasSubstr("no vertex property 'views'"));
  write_ply(folder / "gt_visible.ply", two_points(), {{"views", {1, 0.5}}});
  EXPECT_THAT(error_of(scene), HasSubstr("views of vertex 1 is 0.5"));
  write_ply(folder / "gt_visible.ply", TriMesh(), {{"views", {}}});
  EXPECT_THAT(error_of(scene), HasSubstr("no vertices"));
}

}  // namespace
}  // namespace photohull::eval

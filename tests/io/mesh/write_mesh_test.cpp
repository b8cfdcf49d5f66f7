#include "io/mesh/write_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "core/error.h"
#include "core/image.h"
#include "support/analytic_volumes.h"
#include "support/scratch_folder.h"
#include "volume/extract_mesh.h"

namespace photohull {
namespace {

using testing::HasSubstr;

TriMesh coloured_sphere(const glm::dvec3& origin = glm::dvec3(0), double voxel_size = 1) {
  TriMesh mesh =
      extract_mesh(sample_volume(glm::ivec3(4), sphere(glm::dvec3(16), 9), origin, voxel_size));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const float code = float(i % 256) / 255;
    mesh.colours.push_back(
        {linear_from_srgb(code), linear_from_srgb(1 - code), float(i % 1000) / 999});
    mesh.confidence.push_back(float(i % 7) / 7);
  }
  return mesh;
}

std::string error_of(const std::filesystem::path& path) {
  try {
    read_ply(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Ply, RoundTrip) {
  const ScratchFolder folder;
  const TriMesh mesh = coloured_sphere({1, 2, 3}, 0.5);
  write_ply(folder / "a.ply", mesh);
  EXPECT_THAT(read_text(folder / "a.ply"), HasSubstr("property float x\n"));
  const TriMesh back = read_ply(folder / "a.ply");
  ASSERT_EQ(back.positions.size(), mesh.positions.size());
  EXPECT_EQ(back.triangles, mesh.triangles);
  EXPECT_EQ(back.normals, mesh.normals);
  EXPECT_EQ(back.confidence, mesh.confidence);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    ASSERT_LT(glm::distance(back.world(i), mesh.world(i)), 1e-5);
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(255 * srgb_from_linear(back.colours[i][c]),
                  255 * srgb_from_linear(mesh.colours[i][c]), 0.501);
  }
}

TEST(Ply, ColoursAreRoundedToTheNearestCode) {
  const ScratchFolder folder;
  TriMesh mesh;
  for (int i = 0; i <= 20000; ++i) {
    mesh.positions.emplace_back(i, 0, 0);
    mesh.colours.emplace_back(i / 20000.0f, -0.5f, i == 0 ? NAN : 7.0f);
  }
  write_ply(folder / "a.ply", mesh);
  const TriMesh back = read_ply(folder / "a.ply");
  for (int i = 0; i <= 20000; ++i) {
    const double exact = 255 * srgb_from_linear(i / 20000.0);
    ASSERT_NEAR(255 * srgb_from_linear(back.colours[i].r), exact, 0.5001) << i;
    ASSERT_EQ(back.colours[i].g, 0.0f);
    ASSERT_EQ(back.colours[i].b, i == 0 ? 0.0f : 1.0f);
  }
}

TEST(Ply, DoublesWhereFloatsAreTooCoarse) {
  const ScratchFolder folder;
  const TriMesh mesh = coloured_sphere({5e6, -3e6, 100}, 0.01);
  write_ply(folder / "a.ply", mesh);
  EXPECT_THAT(read_text(folder / "a.ply"), HasSubstr("property double x\n"));
  const TriMesh back = read_ply(folder / "a.ply");
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    ASSERT_LT(glm::distance(back.world(i), mesh.world(i)), 1e-5);
}

TEST(Ply, BareAndEmptyMeshes) {
  const ScratchFolder folder;
  TriMesh bare;
  bare.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  bare.triangles = {{0, 1, 2}};
  write_ply(folder / "bare.ply", bare);
  const TriMesh back = read_ply(folder / "bare.ply");
  EXPECT_EQ(back.triangles, bare.triangles);
  EXPECT_TRUE(back.normals.empty() && back.colours.empty() && back.confidence.empty());
  write_ply(folder / "empty.ply", TriMesh());
  EXPECT_TRUE(read_ply(folder / "empty.ply").positions.empty());
}

TEST(Ply, ReadsAsciiInAnyOrderAndSkipsTheRest) {
  const ScratchFolder folder;
  write_text(folder / "a.ply",
             "ply\r\nformat ascii 1.0\r\ncomment hand made\r\nelement camera 1\r\n"
             "property list uchar float k\r\nelement vertex 4\r\nproperty uchar red\r\n"
             "property uchar green\r\nproperty uchar blue\r\nproperty double z\r\n"
             "property float x\r\nproperty short y\r\nproperty float quality\r\n"
             "element face 1\r\nproperty list uchar uint vertex_index\r\nend_header\r\n"
             "2 0.5 0.25\r\n255 0 0 3 1 2 9\r\n0 255 0 3 2 2 9\r\n0 0 255 3 2 3 9\r\n"
             "0 0 0 3 1 3 9\r\n4 0 1 2 3");
  const TriMesh mesh = read_ply(folder / "a.ply");
  ASSERT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.world(0), glm::dvec3(1, 2, 3));
  EXPECT_EQ(mesh.colours[1], glm::vec3(0, 1, 0));
  ASSERT_EQ(mesh.triangles.size(), 2u);  // the quad as a fan
  EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
}

TEST(Ply, HostileHeadersAreErrors) {
  const ScratchFolder folder;
  const std::string vertex = "property float x\nproperty float y\nproperty float z\n";
  const std::string start = "ply\nformat binary_little_endian 1.0\n";
  const std::string ascii = "ply\nformat ascii 1.0\nelement vertex 1\n" + vertex;
  const std::pair<std::string, std::string> cases[] = {
      {"", "header has no end"},
      {"plx\n", "not a PLY"},
      {"ply\nend_header\n", "names no format"},
      {"ply\nformat binary_big_endian 1.0\nend_header\n", "not supported"},
      {start + "element vertex -1\n", "malformed"},
      {start + "element vertex 99999999999999999999\n", "malformed"},
      {start + "property float x\n", "malformed"},
      {start + "element vertex 1\nproperty complex x\nend_header\n", "unknown type"},
      {start + "element vertex 4000000000\n" + vertex + "end_header\n", "too short"},
      {start + "element vertex 18446744073709551615\n" + vertex + "end_header\n", "too short"},
      {start + "element other 1000000000000\nend_header\n", "too short"},
      {start + "element vertex 1\nproperty float x\nend_header\n1234", "no x, y, z"},
      {start + "element vertex 1\n" + vertex + "property list uchar int n\nend_header\n" +
           std::string(16, '\0'),
       "list properties"},
      {start + "element face 1\nproperty list uint int vertex_indices\nend_header\n" +
           std::string(8, '\xff'),
       "list's length"},
      {start + "element face 1\nproperty list float int vertex_indices\nend_header\n" +
           std::string(8, '\xff'),
       "list's length"},
      {ascii + "end_header\n1 2", "too short"},
      {ascii + "end_header\n1 2 x       ", "not a number"},
      {ascii + "end_header\n1 2 nan", "no usable number"},
      {ascii + "element face 1\nproperty list int int vertex_indices\nend_header\n0 0 0 3 0 0 1",
       "out of range"},
      {ascii + "element face 1\nproperty list int int vertex_indices\nend_header\n0 0 0 3 0 0",
       "ends early"},
      {ascii + "element face 1\nproperty list int int vertex_indices\nend_header\n0 0 0 -3 0 0 0",
       "list's length"},
      {ascii + "element vertex 1\n" + vertex + "end_header\n0 0 0 0 0 0", "more than one"}};
  for (const auto& [text, message] : cases) {
    write_text(folder / "bad.ply", text);
    EXPECT_THAT(error_of(folder / "bad.ply"), HasSubstr(message)) << text;
  }
}

TEST(Ply, EveryTruncationIsAnError) {
  const ScratchFolder folder;
  TriMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.colours.assign(3, glm::vec3(0.5f));
  mesh.triangles = {{0, 1, 2}};
  write_ply(folder / "a.ply", mesh);
  const std::string whole = read_text(folder / "a.ply");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    write_text(folder / "cut.ply", whole.substr(0, size));
    ASSERT_THAT(error_of(folder / "cut.ply"), HasSubstr("cut.ply")) << size;
  }
}

TEST(Ply, MissingFilesAndFoldersAreErrors) {
  const ScratchFolder folder;
  EXPECT_THAT(error_of(folder / "none.ply"), HasSubstr("none.ply"));
  std::filesystem::create_directory(folder / "sub");
  EXPECT_THAT(error_of(folder / "sub"), HasSubstr("it is no file"));
}

TEST(Ply, FullDiskIsAnErrorAndLeavesNothing) {
  const ScratchFolder folder;
  const TriMesh mesh = coloured_sphere();
  const FileSizeLimit limit(20000);
  EXPECT_THROW(write_ply(folder / "a.ply", mesh), Error);
  EXPECT_EQ(folder.file_count(), 0u);
}

}  // namespace
}  // namespace photohull

// Every format that meshes are written in, read back by the reader of any format.
#include "io/mesh/mesh_writers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "core/error.h"
#include "io/mesh/read_mesh.h"
#include "support/scratch_folder.h"

namespace photohull {
namespace {

/// A tetrahedron of four different sides, far from the world's origin.
TriMesh tetrahedron() {
  TriMesh mesh;
  mesh.origin = {100, -20, 3};
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

/// Corners of the triangles in the world, each triangle from its least corner on, which keeps its
/// orientation.
std::set<std::array<std::array<float, 3>, 3>> triangles_of(const TriMesh& mesh) {
  std::set<std::array<std::array<float, 3>, 3>> all;
  for (const auto& t : mesh.triangles) {
    std::array<std::array<float, 3>, 3> corners;
    for (int i = 0; i < 3; ++i) {
      const glm::vec3 p(mesh.world(t[std::size_t(i)]));
      corners[std::size_t(i)] = {p.x, p.y, p.z};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    all.insert(corners);
  }
  return all;
}

TEST(MeshWriters, WriteTheSameTrianglesAnywhere) {
  const ScratchFolder folder;
  for (const MeshWriter& writer : mesh_writers()) {
    if (std::string(writer.name) == "usdz") continue;  // has no reader: textured_writers_test.cpp
    const std::filesystem::path path = folder / (std::string("mesh.") + writer.name);
    AtomicFile file(path);
    const TriMesh mesh = tetrahedron();
    writer.write(file, {mesh, nullptr, {0, 1, 0}}, {});
    file.commit();
    EXPECT_EQ(triangles_of(read_mesh(path)), triangles_of(tetrahedron())) << writer.name;
  }
}

TEST(MeshWriters, UnknownFormatsAreRefusedWithThoseThatThereAre) {
  EXPECT_THAT([] { find_mesh_writer("--export", "doc"); },
              testing::ThrowsMessage<UsageError>(
                  testing::StartsWith("--export: there is no format 'doc'; it is one of ply, ")));
}

}  // namespace
}  // namespace photohull

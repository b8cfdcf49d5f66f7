#include "io/mesh/read_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "core/error.h"
#include "io/mesh/write_mesh.h"
#include "support/scratch_folder.h"

namespace photohull {
namespace {

using testing::HasSubstr;

std::string error_of(const std::filesystem::path& path, Faces faces = Faces::kNeeded) {
  try {
    read_mesh(path, faces);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

double volume_of(const TriMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += glm::dot(mesh.world(a), glm::cross(mesh.world(b), mesh.world(c))) / 6;
  return sum;
}

/// A box [0, 2] x [0, 3] x [0, 4] whose sides are quads; `face` writes the indices of a quad.
const int kQuads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                          {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

glm::vec3 corner(int i) { return {i & 1 ? 2 : 0, i & 2 ? 3 : 0, i & 4 ? 4 : 0}; }

std::string obj_box() {
  std::string text;
  for (int i = 0; i < 8; ++i)
    text += concat("v ", corner(i).x, " ", corner(i).y, " ", corner(i).z, "\n");
  for (const auto& q : kQuads)
    text += concat("f ", q[0] + 1, " ", q[1] + 1, " ", q[2] + 1, " ", q[3] + 1, "\n");
  return text;
}

std::string off_box() {
  std::string text = "OFF\n# a box\n8 6 0\n";
  for (int i = 0; i < 8; ++i) text += concat(corner(i).x, " ", corner(i).y, " ", corner(i).z, "\n");
  for (const auto& q : kQuads) text += concat("4 ", q[0], " ", q[1], " ", q[2], " ", q[3], "\n");
  return text;
}

template <typename T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string stl_box() {
  std::string bytes(80, ' ');
  append(bytes, std::uint32_t(12));
  for (const auto& q : kQuads)
    for (const auto& t : {std::array{q[0], q[1], q[2]}, std::array{q[0], q[2], q[3]}}) {
      append(bytes, glm::vec3(0));
      for (const int i : t) append(bytes, corner(i));
      append(bytes, std::uint16_t(0));
    }
  return bytes;
}

/// A glTF whose one node scales the box by (1, 1, -2) and moves it by (10, 20, 30); its buffer is
/// in `file`, or in the GLB itself where that is empty.
std::string gltf_json(const std::string& file, std::size_t bytes) {
  return concat(
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)",
      R"("nodes":[{"translation":[10,20,30],"children":[1]},{"scale":[1,1,-2],"mesh":0}],)",
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)",
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3",)",
      R"("min":[0,0,0],"max":[2,3,4]},)",
      R"({"bufferView":1,"componentType":5125,"count":36,"type":"SCALAR"}],)",
      R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":96},)",
      R"({"buffer":0,"byteOffset":96,"byteLength":144}],"buffers":[{"byteLength":)", bytes,
      file.empty() ? "" : concat(R"(,"uri":")", file, "\""), "}]}");
}

std::string gltf_buffer(std::uint32_t last = 5) {
  std::string bytes;
  for (int i = 0; i < 8; ++i) append(bytes, corner(i));
  for (const auto& q : kQuads)
    for (const int i : {q[0], q[1], q[2], q[0], q[2], q[3]}) append(bytes, std::uint32_t(i));
  std::memcpy(bytes.data() + bytes.size() - 4, &last, 4);
  return bytes;
}

std::string glb(std::string json, const std::string& buffer) {
  while (json.size() % 4) json += ' ';
  std::string bytes = "glTF";
  append(bytes, std::uint32_t(2));
  append(bytes, std::uint32_t(12 + 8 + json.size() + 8 + buffer.size()));
  append(bytes, std::uint32_t(json.size()));
  bytes += "JSON" + json;
  append(bytes, std::uint32_t(buffer.size()));
  return bytes + std::string("BIN\0", 4) + buffer;
}

TEST(ReadMesh, TheSameBoxInEveryFormat) {
  const ScratchFolder folder;
  write_text(folder / "a.obj", obj_box());
  write_text(folder / "a.OFF", off_box());
  write_text(folder / "a.stl", stl_box());
  write_ply(folder / "a.ply", read_mesh(folder / "a.obj"));
  for (const char* name : {"a.obj", "a.OFF", "a.stl", "a.ply"}) {
    const TriMesh mesh = read_mesh(folder / name);
    EXPECT_EQ(mesh.positions.size(), 8u) << name;
    EXPECT_EQ(mesh.triangles.size(), 12u) << name;
    EXPECT_NEAR(volume_of(mesh), 24, 1e-5) << name;
    EXPECT_EQ(mesh.origin, glm::dvec3(1, 1.5, 2)) << name;
  }
}

TEST(ReadMesh, TransformsOfNodesAreAppliedAndMirrorsKeepFacesOutward) {
  const ScratchFolder folder;
  const std::string buffer = gltf_buffer();
  write_text(folder / "a.gltf", gltf_json("a.bin", buffer.size()));
  write_text(folder / "a.bin", buffer);
  write_text(folder / "a.glb", glb(gltf_json("", buffer.size()), buffer));
  for (const char* name : {"a.gltf", "a.glb"}) {
    const TriMesh mesh = read_mesh(folder / name);
    EXPECT_EQ(mesh.positions.size(), 8u) << name;
    EXPECT_NEAR(volume_of(mesh), 48, 1e-4) << name;
    EXPECT_EQ(mesh.origin, glm::dvec3(11, 21.5, 26)) << name;
  }
}

/// One primitive of a square's four corners, as base64, in one of glTF's ways to list triangles.
std::string gltf_square(int mode, const std::string& more = "") {
  std::string bytes;
  for (const glm::vec3 p :
       {glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(1, 1, 0)})
    append(bytes, p);
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string base64;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) { return unsigned(static_cast<unsigned char>(bytes[k])); };
    const unsigned bits = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (int shift = 18; shift >= 0; shift -= 6) base64 += kDigits[bits >> shift & 63];
  }
  return concat(
      R"({"asset":{"version":"2.0"},)", more,
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":)", mode,
      R"(}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}],)",
      R"("bufferViews":[{"buffer":0,"byteLength":48}],)",
      R"("buffers":[{"byteLength":48,"uri":"data:application/octet-stream;base64,)", base64,
      "\"}]}");
}

TEST(ReadMesh, StripsAndFansOfGltfAreTriangles) {
  const ScratchFolder folder;
  const auto triangles = [&](int mode) {
    write_text(folder / "square.gltf", gltf_square(mode));
    return read_mesh(folder / "square.gltf").triangles;
  };
  using Triangle = std::array<std::uint32_t, 3>;
  EXPECT_THAT(triangles(4), testing::ElementsAre(Triangle{0, 1, 2}));
  EXPECT_THAT(triangles(5), testing::ElementsAre(Triangle{0, 1, 2}, Triangle{2, 1, 3}));
  EXPECT_THAT(triangles(6), testing::ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
}

TEST(ReadMesh, OffWithColoursNormalsAndCountsBesideTheKeyword) {
  const ScratchFolder folder;
  write_text(folder / "a.off",
             "CNOFF 4 2 0 # counts\r\n0 0 0 0 0 1 255 0 0 255\n+1 0 0 0 0 1 1 1 1 1\n\n"
             "1 1 0 0 0 1 1 1 1 1\n0 1 0 0 0 1 1 1 1 1\n4 0 1 2 3 0.5 0.5 0.5\n2 0 1\n");
  const TriMesh mesh = read_mesh(folder / "a.off");
  EXPECT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 2u);
}

TEST(ReadMesh, PointsOnlyWhereFacesAreOptional) {
  const ScratchFolder folder;
  write_text(folder / "a.ply",
             "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
             "property float z\nproperty uchar views\nend_header\n0 0 0 3\n2 2 2 0\n");
  EXPECT_THAT(error_of(folder / "a.ply"), HasSubstr("a.ply: it has no faces"));
  EXPECT_EQ(read_mesh(folder / "a.ply", Faces::kOptional).positions.size(), 2u);
}

TEST(ReadMesh, BadFilesAreErrorsThatNameThem) {
  const ScratchFolder folder;
  const std::string buffer = gltf_buffer();
  const struct {
    const char *name, *message;
    std::string text;
  } cases[] = {
      {"a.xyz", ".ply, .obj, .glb, .gltf, .off or .stl", "0 0 0"},
      {"a", "no extension", "0 0 0"},
      {"empty.obj", "empty.obj", ""},
      {"index.obj", "out of range", obj_box() + "f 1 2 99\n"},
      {"nan.obj", "no usable number", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n"},
      {"huge.obj", "no usable number", "v 0 0 0\nv 1 0 1e38\nv 0 1 0\nf 1 2 3\n"},
      {"index.off", "out of range", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"},
      {"short.off", "too short", "OFF\n4000000000 1 0\n0 0 0\n"},
      {"word.off", "header", "hello\n"},
      {"line.off", "it has no faces", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n"},
      {"cut.stl", "cut.stl", stl_box().substr(0, 200)},
      {"cut.glb", "cut.glb", glb(gltf_json("", buffer.size()), buffer).substr(0, 700)},
      {"index.glb", "index.glb", glb(gltf_json("", buffer.size()), gltf_buffer(4000))},
      {"draco.gltf", "KHR_draco_mesh_compression",
       gltf_square(4, R"("extensionsRequired":["KHR_draco_mesh_compression"],)")},
      {"loop.gltf", "several parents",
       gltf_square(4, R"("scenes":[{"nodes":[0]}],"nodes":[{"children":[0]}],)")},
      {"cut.gltf", "not valid JSON", gltf_square(4).substr(0, 300)},
      {"none.gltf", "none.gltf", gltf_json("missing.bin", buffer.size())},
  };
  for (const auto& c : cases) {
    write_text(folder / c.name, c.text);
    const std::string message = error_of(folder / c.name);
    EXPECT_THAT(message, HasSubstr(c.message)) << c.name;
    EXPECT_THAT(message, HasSubstr((folder / c.name).string())) << c.name;
    EXPECT_THAT(message, Not(HasSubstr("\n"))) << c.name;
  }
  EXPECT_THAT(error_of(folder / "missing.obj"), HasSubstr("it is no file"));
}

TEST(ReadMesh, OtherScalarsOfVerticesComeAlongOnRequest) {
  const ScratchFolder folder;
  TriMesh points;
  points.positions = {{0, 0, 0}, {1, 2, 3}, {4, 5, 6}};
  points.confidence = {1, 0, 1};
  write_ply(folder / "a.ply", points, {{"distance", {-0.5, 0.25, 8}}, {"views", {3, 0, 255}}});
  VertexScalars scalars = {{"stale", {1}}};
  const TriMesh back = read_ply(folder / "a.ply", scalars);
  EXPECT_EQ(back.positions.size(), 3u);
  EXPECT_EQ(back.confidence, points.confidence);
  EXPECT_THAT(scalars,
              testing::ElementsAre(testing::Pair("distance", testing::ElementsAre(-0.5, 0.25, 8)),
                                   testing::Pair("views", testing::ElementsAre(3, 0, 255))));
}

}  // namespace
}  // namespace photohull

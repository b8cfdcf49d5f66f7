// Files that hold a texture, read back by assimp, and those that it does not read by what they must
// hold.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>
#include <cstring>
#include <deque>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/error.h"
#include "io/image_file.h"
#include "io/mesh/mesh_writers.h"
#include "io/mesh/read_mesh.h"
#include "io/mesh/read_textured.h"
#include "io/mesh/split_mesh.h"
#include "support/scratch_folder.h"
#include "written_mesh.h"

namespace photohull {
namespace {

constexpr int kEdge = 8;

/// Of each side of the tetrahedron: red, green, blue, white; two sides a page.
constexpr std::uint8_t kColours[4][3] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}};

/// A tetrahedron of four different sides, each of a colour, on two pages whose left half is the
/// first side's and whose right half the second's.
TexturedMesh tetrahedron() {
  TexturedMesh out;
  TriMesh& mesh = out.mesh;
  mesh.origin = {100, -20, 3};
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  mesh.normals = {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.colours.assign(4, glm::vec3(0.25f));
  mesh.confidence = {0, 0.25f, 0.5f, 1};
  for (std::uint32_t p = 0; p < 2; ++p) {
    RgbImage page{kEdge, kEdge, {}};
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x) {
        const std::uint8_t* c = kColours[2 * p + (x < kEdge / 2 ? 0u : 1u)];
        page.rgb.insert(page.rgb.end(), c, c + 3);
      }
    out.texture.pages.push_back(page);
  }
  for (std::uint32_t t = 0; t < 4; ++t) {
    const float left = t % 2 ? 0.6f : 0.1f;
    out.texture.page.push_back(t / 2);
    out.texture.corners.push_back({glm::vec2(left, 0.1f), {left + 0.3f, 0.2f}, {left, 0.9f}});
  }
  return out;
}

/// A triangle as a reader has it: corners, and the colour of its page in its middle.
struct Read {
  std::array<glm::dvec3, 3> corners;
  std::array<int, 3> colour{};
};

ColourImage page_of(const aiScene& scene, const aiMesh& mesh, const ScratchFolder& folder) {
  aiString name;
  EXPECT_EQ(scene.mMaterials[mesh.mMaterialIndex]->GetTexture(aiTextureType_DIFFUSE, 0, &name),
            aiReturn_SUCCESS);
  const aiTexture* embedded = scene.GetEmbeddedTexture(name.C_Str());
  if (!embedded) return io::read_image(folder / name.C_Str());
  EXPECT_EQ(embedded->mHeight, 0u);  // compressed
  const std::filesystem::path path = folder / "page.png";
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(embedded->pcData), embedded->mWidth);
  return io::read_image(path);
}

std::vector<Read> read_by_assimp(const std::filesystem::path& path, const ScratchFolder& folder) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path.string(), aiProcess_PreTransformVertices);
  EXPECT_TRUE(scene) << importer.GetErrorString();
  std::vector<Read> all;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    EXPECT_FALSE(mesh.HasVertexColors(0));  // they would be multiplied in
    EXPECT_TRUE(mesh.HasNormals());
    const ColourImage page = page_of(*scene, mesh, folder);
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      Read read;
      glm::dvec2 middle(0);
      for (unsigned i = 0; i < 3; ++i) {
        const unsigned v = mesh.mFaces[f].mIndices[i];
        read.corners[i] = {mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z};
        const aiVector3D& at = mesh.mTextureCoords[0][v];  // from below
        middle += glm::dvec2(at.x, 1 - at.y) / 3.0;
      }
      const std::uint8_t* p = &page.bytes[4 * std::size_t(int(middle.y * page.height) * page.width +
                                                          int(middle.x * page.width))];
      read.colour = {p[0], p[1], p[2]};
      all.push_back(read);
    }
  }
  return all;
}

/// In any order, but each with its own colour and turned as it was.
void expect_sides(const std::vector<Read>& read, const glm::dmat3& turn) {
  const TexturedMesh truth = tetrahedron();
  ASSERT_EQ(read.size(), 4u);
  for (std::size_t t = 0; t < 4; ++t) {
    const std::array<int, 3> colour{kColours[t][0], kColours[t][1], kColours[t][2]};
    const auto found =
        std::ranges::find_if(read, [&](const Read& r) { return r.colour == colour; });
    ASSERT_NE(found, read.end()) << t;
    const auto& corners = truth.mesh.triangles[t];
    const auto distance = [&](int shift) {
      double most = 0;
      for (int i = 0; i < 3; ++i)
        most = std::max(most, glm::distance(turn * truth.mesh.world(corners[std::size_t(i)]),
                                            found->corners[std::size_t((i + shift) % 3)]));
      return most;
    };
    EXPECT_LT(std::min({distance(0), distance(1), distance(2)}), 1e-4) << t;
  }
}

TEST(TexturedWriters, GlbHasEachSideInItsColourWithYUp) {
  const ScratchFolder folder;
  const TexturedMesh t = tetrahedron();
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      glm::dvec3 up(0);
      up[axis] = sign;
      const auto path = write(folder, "glb", {t.mesh, &t.texture, up});
      expect_sides(read_by_assimp(path, folder), y_up_from_world(up));
    }
}

TEST(TexturedWriters, ZUpTurnsAsModellersDo) {
  EXPECT_EQ(y_up_from_world({0, 0, 1}) * glm::dvec3(1, 2, 3), glm::dvec3(1, 3, -2));
  EXPECT_EQ(y_up_from_world({0, 1, 0}) * glm::dvec3(1, 2, 3), glm::dvec3(1, 2, 3));
  EXPECT_EQ(y_up_from_world({0, -1, 0}) * glm::dvec3(1, 2, 3), glm::dvec3(1, -2, -3));
  for (const glm::dvec3& up : {glm::dvec3(1, 0, 0), {-1, 0, 0}, {0, 0, -1}}) {
    EXPECT_EQ(y_up_from_world(up) * up, glm::dvec3(0, 1, 0));
    EXPECT_EQ(glm::determinant(y_up_from_world(up)), 1);
  }
}

TEST(TexturedWriters, GlbKeepsConfidence) {
  const ScratchFolder folder;
  const TexturedMesh t = tetrahedron();
  EXPECT_THAT(bytes_of(write(folder, "glb", {t.mesh, &t.texture})),
              testing::AllOf(testing::HasSubstr("_CONFIDENCE"),
                             testing::Not(testing::HasSubstr("COLOR_0"))));
}

TEST(TexturedWriters, GlbWithoutATextureHasTheVerticesColours) {
  const ScratchFolder folder;
  const TexturedMesh t = tetrahedron();
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(write(folder, "glb", {t.mesh}).string(), 0);
  ASSERT_TRUE(scene) << importer.GetErrorString();
  ASSERT_TRUE(scene->mMeshes[0]->HasVertexColors(0));
  EXPECT_NEAR(scene->mMeshes[0]->mColors[0][0].g, 0.25, 1e-4);  // linear, as the format has it
  EXPECT_EQ(scene->mMeshes[0]->mNumVertices, 4u);
}

TEST(TexturedWriters, ObjHasEachSideInItsColour) {
  const ScratchFolder folder;
  const TexturedMesh t = tetrahedron();
  const auto path = write(folder, "obj", {t.mesh, &t.texture, {0, 0, 1}});
  EXPECT_TRUE(std::filesystem::exists(folder / "mesh.mtl"));
  EXPECT_TRUE(std::filesystem::exists(folder / "mesh_1.png"));
  expect_sides(read_by_assimp(path, folder), glm::dmat3(1));  // world coordinates
}

TEST(TexturedWriters, VerticesAreThoseOfChartsAndNoMore) {
  TexturedMesh t = tetrahedron();
  t.texture.pages.pop_back();
  t.texture.page.assign(4, 0);
  t.texture.corners.assign(4, {glm::vec2(0.5f), glm::vec2(0.5f), glm::vec2(0.5f)});
  const std::vector<MeshPart> parts = split_by_pages({t.mesh, &t.texture});
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].vertices, (std::vector<std::uint32_t>{0, 1, 2, 3}));
  EXPECT_EQ(parts[0].triangles, t.mesh.triangles);
}

std::uint32_t number(const std::string& bytes, std::size_t at, int count) {
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i)
    value |= std::uint32_t(std::uint8_t(bytes[at + std::size_t(i)])) << (8 * i);
  return value;
}

/// Files of a zip archive, by its list at the end. Fails where they are compressed, damaged, or do
/// not begin at a multiple of 64 bytes.
std::vector<std::pair<std::string, std::string>> unzip(const std::string& bytes) {
  std::vector<std::pair<std::string, std::string>> files;
  const std::size_t end = bytes.size() - 22;
  EXPECT_EQ(number(bytes, end, 4), 0x06054b50u);
  std::size_t at = number(bytes, end + 16, 4);
  for (std::uint32_t i = 0; i < number(bytes, end + 10, 2); ++i) {
    EXPECT_EQ(number(bytes, at, 4), 0x02014b50u);
    EXPECT_EQ(number(bytes, at + 10, 2), 0u);  // stored
    const std::uint32_t crc = number(bytes, at + 16, 4), size = number(bytes, at + 24, 4),
                        name = number(bytes, at + 28, 2), local = number(bytes, at + 42, 4);
    EXPECT_EQ(number(bytes, local, 4), 0x04034b50u);
    const std::size_t data =
        local + 30 + number(bytes, local + 26, 2) + number(bytes, local + 28, 2);
    EXPECT_EQ(data % 64, 0u);
    files.emplace_back(bytes.substr(at + 46, name), bytes.substr(data, size));
    const std::string& content = files.back().second;
    EXPECT_EQ(crc32(0, reinterpret_cast<const Bytef*>(content.data()), uInt(content.size())), crc);
    at += 46 + name;
  }
  return files;
}

TEST(TexturedWriters, UsdzHoldsALayerAndThePages) {
  const ScratchFolder folder;
  const TexturedMesh t = tetrahedron();
  const auto files = unzip(bytes_of(write(folder, "usdz", {t.mesh, &t.texture, {0, 0, 1}})));
  ASSERT_EQ(files.size(), 3u);
  EXPECT_EQ(files[0].first, "model.usda");  // the first is the one that is opened
  EXPECT_EQ(files[1].first, "textures/page_0.png");
  EXPECT_EQ(files[2].first, "textures/page_1.png");
  const std::string& layer = files[0].second;
  EXPECT_THAT(layer, testing::StartsWith("#usda 1.0"));
  EXPECT_THAT(layer, testing::HasSubstr("upAxis = \"Y\""));
  EXPECT_THAT(layer, testing::HasSubstr("@textures/page_1.png@"));
  EXPECT_THAT(layer, testing::HasSubstr("xformOp:translate = (100, 3, 20)"));
  EXPECT_THAT(layer, testing::HasSubstr("(0, 3, 0)"));  // the corner that was up
  const std::filesystem::path page = folder / "page.png";
  std::ofstream(page, std::ios::binary) << files[1].second;
  EXPECT_EQ(io::read_image(page).width, kEdge);
}

TEST(TexturedWriters, TheSameBytesEveryTime) {
  const ScratchFolder folder;
  const TexturedMesh t = tetrahedron();
  for (const std::string format : {"glb", "obj", "usdz"}) {
    const std::string first = bytes_of(write(folder, format, {t.mesh, &t.texture}));
    EXPECT_EQ(bytes_of(write(folder, format, {t.mesh, &t.texture})), first) << format;
  }
}

TEST(TexturedMeshes, OfGlbComeBackAsTheyWere) {
  const ScratchFolder folder;
  const TexturedMesh given = tetrahedron();
  for (const glm::dvec3& up : {glm::dvec3(0, 0, 1), glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0)}) {
    const TexturedMesh back =
        read_textured_glb(write(folder, "glb", {given.mesh, &given.texture, up}), up);
    ASSERT_EQ(back.mesh.triangles.size(), given.mesh.triangles.size());
    ASSERT_EQ(back.texture.pages.size(), 2u);
    for (std::size_t p = 0; p < 2; ++p)
      EXPECT_EQ(back.texture.pages[p].rgb, given.texture.pages[p].rgb);
    EXPECT_EQ(back.texture.page, given.texture.page);
    EXPECT_EQ(back.texture.corners, given.texture.corners);
    for (std::size_t t = 0; t < 4; ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t a = given.mesh.triangles[t][c], b = back.mesh.triangles[t][c];
        EXPECT_LT(glm::distance(back.mesh.world(b), given.mesh.world(a)), 1e-6);
        EXPECT_LT(glm::distance(back.mesh.normals[b], given.mesh.normals[a]), 1e-6);
      }
  }
}

TEST(TexturedMeshes, OfGlbInMetresComeBackInSceneUnits) {
  const ScratchFolder folder;
  TexturedMesh given = tetrahedron();
  given.mesh.origin = {100, -200, 300};
  MeshContents contents{given.mesh, &given.texture, {0, 0, 1}};
  contents.options.unit = LengthUnit::kMillimetre;
  const TexturedMesh back = read_textured_glb(write(folder, "glb", contents), {0, 0, 1});
  for (std::size_t t = 0; t < 4; ++t)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_LT(glm::distance(back.mesh.world(back.mesh.triangles[t][c]),
                              given.mesh.world(given.mesh.triangles[t][c])),
                1e-6);
}

TEST(TexturedMeshes, OfOtherOrDamagedFilesAreRefused) {
  const ScratchFolder folder;
  const TexturedMesh given = tetrahedron();
  const std::filesystem::path plain = write(folder, "glb", {given.mesh, nullptr, {0, 0, 1}});
  const auto refusal = [&](const std::filesystem::path& path) -> std::string {
    try {
      read_textured_glb(path, {0, 0, 1});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal(plain), testing::HasSubstr("no baseColorTexture"));
  const std::string whole = bytes_of(write(folder, "glb", {given.mesh, &given.texture, {0, 0, 1}}));
  const std::filesystem::path damaged = folder / "damaged.glb";
  for (std::size_t at = 0; at < whole.size(); at += 7) {
    std::string bytes = whole;
    bytes[at] = char(bytes[at] ^ 0x15);
    std::ofstream(damaged, std::ios::binary) << bytes;
    const std::string said = refusal(damaged);  // some damage cannot be seen
    EXPECT_TRUE(said.empty() || said.find(damaged.string()) != std::string::npos) << said;
    std::ofstream(damaged, std::ios::binary) << whole.substr(0, at);
    EXPECT_NE(refusal(damaged), "") << at;
  }
}

}  // namespace
}  // namespace photohull

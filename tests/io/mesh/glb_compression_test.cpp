// Compressed GLB files, decoded by the codecs' own library, and lengths in all formats.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <deque>
#include <fstream>
#include <nlohmann/json.hpp>
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

using Json = nlohmann::json;

/// A bent sheet of 20 x 30 squares, all of whose vertices differ in all that they have.
TexturedMesh sheet() {
  constexpr std::uint32_t kWide = 21, kHigh = 31;
  TexturedMesh out;
  TriMesh& mesh = out.mesh;
  mesh.origin = {10, -20, 30};
  for (std::uint32_t y = 0; y < kHigh; ++y)
    for (std::uint32_t x = 0; x < kWide; ++x) {
      const float u = float(x) / (kWide - 1), v = float(y) / (kHigh - 1);
      mesh.positions.emplace_back(2 * u, 5 * v, 0.5f * u * v + 0.1f * std::sin(9 * u));
      mesh.normals.push_back(glm::normalize(glm::vec3(u - 0.5f, v - 0.3f, 1)));
      mesh.confidence.push_back(0.5f * (u + v));
    }
  for (std::uint32_t y = 0; y + 1 < kHigh; ++y)
    for (std::uint32_t x = 0; x + 1 < kWide; ++x) {
      const std::uint32_t a = y * kWide + x, b = a + 1, c = a + kWide, d = c + 1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({b, d, c});
    }
  RgbImage page{16, 16, {}};
  for (std::uint8_t i = 0; page.rgb.size() < 3 * 256; ++i)
    page.rgb.insert(page.rgb.end(), {i, std::uint8_t(255 - i), std::uint8_t(i / 2)});
  out.texture.pages.push_back(page);
  for (const auto& t : mesh.triangles) {
    out.texture.page.push_back(0);
    std::array<glm::vec2, 3> places;
    for (std::size_t i = 0; i < 3; ++i)
      places[i] = {mesh.positions[t[i]].x / 4, mesh.positions[t[i]].y / 8};
    out.texture.corners.push_back(places);
  }
  return out;
}

/// A GLB file whose accessors are decoded.
class Glb {
 public:
  explicit Glb(const std::string& bytes) {
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, 4);
    root = Json::parse(bytes.substr(20, length));
    binary_ = bytes.substr(28 + length);
  }

  /// Of each element `components` numbers, as they are stored.
  template <typename T>
  std::vector<std::vector<T>> values(const Json& accessor, std::size_t components) const {
    const Json& view = root["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const Json& code = view["extensions"]["EXT_meshopt_compression"];
    const std::size_t count = code["count"], stride = code["byteStride"];
    EXPECT_EQ(view["byteLength"], count * stride);
    EXPECT_EQ(view["buffer"], 1);
    std::vector<unsigned char> plain(count * stride);
    const auto* first = reinterpret_cast<const unsigned char*>(binary_.data()) +
                        code["byteOffset"].get<std::size_t>();
    const std::size_t size = code["byteLength"];
    EXPECT_EQ(code["mode"] == "TRIANGLES"
                  ? meshopt_decodeIndexBuffer(plain.data(), count, stride, first, size)
                  : meshopt_decodeVertexBuffer(plain.data(), count, stride, first, size),
              0);
    EXPECT_EQ(accessor["count"], count);
    std::vector<std::vector<T>> out(count, std::vector<T>(components));
    for (std::size_t i = 0; i < count; ++i)
      std::memcpy(out[i].data(), &plain[i * stride], components * sizeof(T));
    return out;
  }

  Json root;

 private:
  std::string binary_;
};

MeshContents compressed(const TexturedMesh& t) {
  MeshContents contents{t.mesh, &t.texture, {0, 0, 1}};
  contents.options.compress = true;
  return contents;
}

TEST(CompressedGlb, DecodesToTheMeshWithinItsSteps) {
  const ScratchFolder folder;
  const TexturedMesh t = sheet();
  const Glb glb(bytes_of(write(folder, "glb", compressed(t))));
  const Json &primitive = glb.root["meshes"][0]["primitives"][0], &node = glb.root["nodes"][0];
  const auto accessor = [&](const Json& index) { return glb.root["accessors"][index.get<int>()]; };
  const Json& attributes = primitive["attributes"];
  const auto positions = glb.values<std::uint16_t>(accessor(attributes["POSITION"]), 3);
  const auto normals = glb.values<std::int8_t>(accessor(attributes["NORMAL"]), 3);
  const auto places = glb.values<std::uint16_t>(accessor(attributes["TEXCOORD_0"]), 2);
  const auto confidence = glb.values<std::uint16_t>(accessor(attributes["_CONFIDENCE"]), 1);
  const auto corners = glb.values<std::uint32_t>(accessor(primitive["indices"]), 1);
  ASSERT_EQ(positions.size(), t.mesh.positions.size());
  ASSERT_EQ(corners.size(), 3 * t.mesh.triangles.size());
  const double step = node["scale"][0];
  EXPECT_NEAR(step, 5.0 / 65535, 1e-9);
  const glm::dmat3 turn = y_up_from_world({0, 0, 1});
  std::vector<int> found(t.mesh.positions.size(), 0);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    glm::dvec3 p;
    for (int c = 0; c < 3; ++c)
      p[c] =
          node["translation"][std::size_t(c)].get<double>() + step * positions[i][std::size_t(c)];
    std::size_t nearest = 0;
    for (std::size_t v = 0; v < found.size(); ++v)
      if (glm::distance(turn * t.mesh.world(v), p) < glm::distance(turn * t.mesh.world(nearest), p))
        nearest = v;
    ++found[nearest];
    EXPECT_LT(glm::distance(turn * t.mesh.world(nearest), p), step);
    const glm::dvec3 n = turn * glm::dvec3(t.mesh.normals[nearest]);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(normals[i][std::size_t(c)] / 127.0, n[c], 0.5 / 127);
    EXPECT_NEAR(places[i][0] / 65535.0, t.mesh.positions[nearest].x / 4, 1.0 / 65535);
    EXPECT_NEAR(places[i][1] / 65535.0, t.mesh.positions[nearest].y / 8, 1.0 / 65535);
    EXPECT_NEAR(confidence[i][0] / 65535.0, t.mesh.confidence[nearest], 1.0 / 65535);
  }
  EXPECT_THAT(found, testing::Each(1));
  // Triangles still face the way they did: their normals point up.
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    std::array<glm::dvec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c) p[k][c] = positions[corners[i + k][0]][std::size_t(c)];
    EXPECT_GT(glm::cross(p[1] - p[0], p[2] - p[0]).y, 0);
  }
}

TEST(CompressedGlb, SaysWhatReadersNeedAndIsSmaller) {
  const ScratchFolder folder;
  TexturedMesh t = sheet();
  const std::string plain = bytes_of(write(folder, "glb", {t.mesh, &t.texture}));
  const std::string small = bytes_of(write(folder, "glb", compressed(t)));
  EXPECT_LT(small.size(), plain.size() / 2);
  EXPECT_EQ(bytes_of(write(folder, "glb", compressed(t))), small);
  const Glb glb(small);
  for (const char* list : {"extensionsUsed", "extensionsRequired"})
    EXPECT_THAT(glb.root[list].get<std::vector<std::string>>(),
                testing::ElementsAre("EXT_meshopt_compression", "KHR_mesh_quantization"));
  EXPECT_TRUE(glb.root["buffers"][1]["extensions"]["EXT_meshopt_compression"]["fallback"]);
}

glm::dvec3 corner(const TriMesh& mesh, std::size_t triangle, std::size_t i) {
  return mesh.world(mesh.triangles[triangle][i]);
}

/// The triangle of `mesh` that lies where one of `other` does, by the sum of its corners.
std::size_t nearest_triangle(const TriMesh& mesh, const TriMesh& other, std::size_t triangle) {
  const auto sum = [](const TriMesh& m, std::size_t t) {
    return corner(m, t, 0) + corner(m, t, 1) + corner(m, t, 2);
  };
  std::size_t nearest = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (glm::distance(sum(mesh, t), sum(other, triangle)) <
        glm::distance(sum(mesh, nearest), sum(other, triangle)))
      nearest = t;
  return nearest;
}

TEST(CompressedGlb, ReadsBackInSceneUnits) {
  const ScratchFolder folder;
  const TexturedMesh t = sheet();
  for (const auto unit : {std::optional<LengthUnit>(), std::optional(LengthUnit::kMillimetre)}) {
    MeshContents contents = compressed(t);
    contents.options.unit = unit;
    const std::filesystem::path path = write(folder, "glb", contents);
    const TexturedMesh back = read_textured_glb(path, {0, 0, 1});
    EXPECT_EQ(back.texture.pages[0].rgb, t.texture.pages[0].rgb);
    ASSERT_EQ(back.mesh.triangles.size(), t.mesh.triangles.size());
    const double step = 5.0 / 65535;
    std::vector<int> found(t.mesh.triangles.size());
    for (std::size_t f = 0; f < back.mesh.triangles.size(); ++f) {
      const std::size_t given = nearest_triangle(t.mesh, back.mesh, f);
      ++found[given];
      std::size_t first = 0;  // codecs turn triangles
      for (std::size_t i = 1; i < 3; ++i)
        if (glm::distance(corner(t.mesh, given, i), corner(back.mesh, f, 0)) <
            glm::distance(corner(t.mesh, given, first), corner(back.mesh, f, 0)))
          first = i;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (first + i) % 3;
        EXPECT_LT(glm::distance(corner(t.mesh, given, j), corner(back.mesh, f, i)), step);
        EXPECT_LT(glm::distance(t.texture.corners[given][j], back.texture.corners[f][i]), 2e-5f);
        EXPECT_LT(glm::distance(t.mesh.normals[t.mesh.triangles[given][j]],
                                back.mesh.normals[back.mesh.triangles[f][i]]),
                  0.01f);
      }
    }
    EXPECT_THAT(found, testing::Each(1));
    // And as any file's triangles, in the file's metres with +Y up.
    const TriMesh plain = read_mesh(path);
    ASSERT_EQ(plain.triangles.size(), t.mesh.triangles.size());
    const double metres = unit ? 0.001 : 1;
    const glm::dmat3 turn = y_up_from_world({0, 0, 1});
    for (std::size_t f = 0; f < plain.triangles.size(); f += 17)
      EXPECT_LT(glm::distance(corner(plain, f, 0), metres * (turn * corner(back.mesh, f, 0))),
                step * metres);
  }
}

TEST(CompressedGlb, DamagedOnesAreRefusedByName) {
  const ScratchFolder folder;
  const TexturedMesh t = sheet();
  const std::string whole = bytes_of(write(folder, "glb", compressed(t)));
  const std::filesystem::path damaged = folder / "damaged.glb";
  const auto refusal = [&](const std::string& bytes) -> std::string {
    std::ofstream(damaged, std::ios::binary) << bytes;
    try {
      read_textured_glb(damaged, {0, 0, 1});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  for (std::size_t at = 0; at < whole.size(); at += 13) {
    std::string bytes = whole;
    bytes[at] = char(bytes[at] ^ 0x15);
    const std::string said = refusal(bytes);  // some damage cannot be seen
    EXPECT_TRUE(said.empty() || said.find(damaged.string()) != std::string::npos) << said;
    EXPECT_NE(refusal(whole.substr(0, at)), "") << at;
  }
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string bytes = whole;
    bytes.replace(bytes.find(from), from.size(), to);
    return refusal(bytes);
  };
  EXPECT_THAT(changed("\"mode\":\"ATTRIBUTES\"", "\"mode\":\"TRIBUTES\"  "),
              testing::HasSubstr("is none of EXT_meshopt_compression"));
  EXPECT_THAT(changed("\"count\":651,\"mode\"", "\"count\":6510000,\"mod\""),
              testing::HasSubstr("damaged.glb"));
}

/// The longest side of the bounds of what assimp reads.
double length_of(const std::filesystem::path& path) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path.string(), aiProcess_PreTransformVertices);
  EXPECT_TRUE(scene) << importer.GetErrorString();
  glm::dvec3 low(1e30), high(-1e30);
  for (unsigned m = 0; scene && m < scene->mNumMeshes; ++m)
    for (unsigned v = 0; v < scene->mMeshes[m]->mNumVertices; ++v) {
      const aiVector3D& p = scene->mMeshes[m]->mVertices[v];
      low = glm::min(low, glm::dvec3(p.x, p.y, p.z));
      high = glm::max(high, glm::dvec3(p.x, p.y, p.z));
    }
  const glm::dvec3 size = high - low;
  return std::max({size.x, size.y, size.z});
}

TEST(Units, EachFormatHasItsOwn) {
  const ScratchFolder folder;
  const TexturedMesh t = sheet();  // 5 units long
  struct Case {
    std::optional<LengthUnit> unit;
    double stl, glb;
    const char* usdz;
  };
  for (const Case& c : {Case{std::nullopt, 5, 5, "metersPerUnit = 1\n"},
                        {LengthUnit::kMillimetre, 5, 0.005, "metersPerUnit = 0.001\n"},
                        {LengthUnit::kCentimetre, 50, 0.05, "metersPerUnit = 0.01\n"},
                        {LengthUnit::kMetre, 5000, 5, "metersPerUnit = 1\n"},
                        {LengthUnit::kInch, 127, 0.127, "metersPerUnit = 0.0254\n"}}) {
    MeshContents contents{t.mesh, &t.texture, {0, 0, 1}};
    contents.options.unit = c.unit;
    EXPECT_NEAR(length_of(write(folder, "stl", contents)), c.stl, 1e-5 * c.stl);
    EXPECT_NEAR(length_of(write(folder, "glb", contents)), c.glb, 1e-5 * c.glb);
    EXPECT_NEAR(length_of(write(folder, "obj", contents)), 5, 1e-5);
    EXPECT_THAT(bytes_of(write(folder, "usdz", contents)), testing::HasSubstr(c.usdz));
    contents.options.compress = true;
    const Glb glb(bytes_of(write(folder, "glb", contents)));
    EXPECT_NEAR(glb.root["nodes"][0]["scale"][0].get<double>() * 65535, c.glb, 1e-5 * c.glb);
  }
}

TEST(TextureFormats, JpegIsInAllFilesThatHoldATexture) {
  const ScratchFolder folder;
  TexturedMesh t = sheet();
  t.texture.pages[0] = {16, 16, std::vector<std::uint8_t>(3 * 256, 128)};
  MeshContents contents{t.mesh, &t.texture, {0, 0, 1}};
  contents.options.texture_format = TextureFormat::kJpeg;
  EXPECT_THAT(bytes_of(write(folder, "usdz", contents)),
              testing::HasSubstr("@textures/page_0.jpg@"));
  write(folder, "obj", contents);
  EXPECT_THAT(bytes_of(folder / "mesh.mtl"), testing::HasSubstr("map_Kd mesh_0.jpg"));
  EXPECT_NEAR(io::read_image(folder / "mesh_0.jpg").bytes[0], 128, 1);
  const Glb glb(bytes_of(write(folder, "glb", contents)));
  EXPECT_EQ(glb.root["images"][0]["mimeType"], "image/jpeg");
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile((folder / "mesh.glb").string(), 0);
  ASSERT_TRUE(scene) << importer.GetErrorString();
  ASSERT_EQ(scene->mNumTextures, 1u);
  EXPECT_EQ(std::string(scene->mTextures[0]->achFormatHint), "jpg");
}

}  // namespace
}  // namespace photohull

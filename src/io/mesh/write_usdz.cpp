// Universal Scene Description in a zip archive: a layer as text, and the texture's pages.
#include <array>
#include <cstdio>
#include <limits>
#include <string>

#include "core/error.h"
#include "io/mesh/mesh_writers.h"
#include "io/mesh/split_mesh.h"
#include "io/mesh/stored_zip.h"

namespace photohull {
namespace {

/// Numbers that are needed to tell floats apart.
template <typename... Numbers>
void append(std::string& text, const char* format, Numbers... numbers) {
  std::array<char, 160> buffer;
  const int length = std::snprintf(buffer.data(), buffer.size(), format, numbers...);
  PHOTOHULL_CHECK(length > 0 && length < int(buffer.size()));
  text.append(buffer.data(), std::size_t(length));
}

class UsdLayer {
 public:
  explicit UsdLayer(const MeshContents& contents)
      : contents_(contents), mesh_(contents.mesh), turn_(y_up_from_world(contents.up)) {}

  std::string text() {
    const std::vector<MeshPart> parts = split_by_pages(contents_);
    const glm::dvec3 origin = turn_ * mesh_.origin;
    text_ = concat("#usda 1.0\n(\n    defaultPrim = \"model\"\n    doc = \"photohull ",
                   PHOTOHULL_VERSION, "\"\n    metersPerUnit = ", contents_.options.metres(),
                   "\n    upAxis = \"Y\"\n)\n\n"
                   "def Xform \"model\" (\n    kind = \"component\"\n)\n{\n");
    append(text_, "    double3 xformOp:translate = (%.17g, %.17g, %.17g)\n", origin.x, origin.y,
           origin.z);
    text_ += "    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n";
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (parts[p].triangles.empty()) continue;
      add_part(parts[p], p);
      add_material(p);
    }
    return text_ + "}\n";
  }

 private:
  /// `name = [one, two, ...]` of `count` elements that `element(i)` appends.
  template <typename Element>
  void add_list(const char* name, std::size_t count, const Element& element,
                const char* more = "") {
    text_ += concat("        ", name, " = [");
    for (std::size_t i = 0; i < count; ++i) {
      if (i > 0) text_ += ", ";
      element(i);
    }
    text_ += concat("]", more, "\n");
  }

  void add_vector(const glm::vec3& v) {
    append(text_, "(%.9g, %.9g, %.9g)", double(v.x), double(v.y), double(v.z));
  }

  void add_part(const MeshPart& part, std::size_t page) {
    constexpr const char* kVertex = " (\n            interpolation = \"vertex\"\n        )";
    const std::size_t count = part.vertices.size();
    const auto position = [&](std::size_t i) {
      return glm::mat3(turn_) * mesh_.positions[part.vertices[i]];
    };
    glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
    for (std::size_t i = 0; i < count; ++i) {
      low = glm::min(low, position(i));
      high = glm::max(high, position(i));
    }
    text_ += concat("    def Mesh \"part_", page,
                    "\" (\n        prepend apiSchemas = [\"MaterialBindingAPI\"]\n    )\n    {\n");
    add_list("float3[] extent", 2, [&](std::size_t i) { add_vector(i ? high : low); });
    add_list("int[] faceVertexCounts", part.triangles.size(), [&](std::size_t) { text_ += '3'; });
    add_list("int[] faceVertexIndices", 3 * part.triangles.size(),
             [&](std::size_t i) { text_ += std::to_string(part.triangles[i / 3][i % 3]); });
    add_list("point3f[] points", count, [&](std::size_t i) { add_vector(position(i)); });
    if (!mesh_.normals.empty())
      add_list(
          "normal3f[] normals", count,
          [&](std::size_t i) {
            add_vector(glm::mat3(turn_) * unit_normal(mesh_, part.vertices[i]));
          },
          kVertex);
    if (!part.places.empty())
      add_list(
          "texCoord2f[] primvars:st", count,
          [&](std::size_t i) {
            append(text_, "(%.9g, %.9g)", double(part.places[i].x), 1 - double(part.places[i].y));
          },
          kVertex);
    else if (!mesh_.colours.empty())
      add_list(
          "color3f[] primvars:displayColor", count,
          [&](std::size_t i) { add_vector(mesh_.colours[part.vertices[i]]); }, kVertex);
    text_ += concat("        uniform token subdivisionScheme = \"none\"\n",
                    "        rel material:binding = </model/material_", page, ">\n    }\n");
  }

  void add_material(std::size_t page) {
    const std::string path = concat("/model/material_", page);
    const bool textured = contents_.texture;
    text_ +=
        concat("    def Material \"material_", page,
               "\"\n    {\n        token outputs:surface.connect = <", path,
               "/surface.outputs:surface>\n        def Shader \"surface\"\n        {\n",
               "            uniform token info:id = \"UsdPreviewSurface\"\n",
               "            color3f inputs:diffuseColor.connect = <", path,
               textured ? "/texture.outputs:rgb>\n" : "/colour.outputs:result>\n",
               "            float inputs:metallic = 0\n            float inputs:roughness = 1\n",
               "            token outputs:surface\n        }\n");
    if (textured)
      add_texture(path, page);
    else
      add_reader("colour", "float3", "displayColor");
    text_ += "    }\n";
  }

  void add_texture(const std::string& path, std::size_t page) {
    text_ += concat(
        "        def Shader \"texture\"\n        {\n",
        "            uniform token info:id = \"UsdUVTexture\"\n            asset inputs:file = @",
        page_path(page), "@\n            token inputs:sourceColorSpace = \"sRGB\"\n",
        "            float2 inputs:st.connect = <", path, "/place.outputs:result>\n",
        "            token inputs:wrapS = \"clamp\"\n            token inputs:wrapT = \"clamp\"\n",
        "            float3 outputs:rgb\n        }\n");
    add_reader("place", "float2", "st");
  }

  void add_reader(const char* name, const char* type, const char* variable) {
    text_ += concat("        def Shader \"", name, "\"\n        {\n",
                    "            uniform token info:id = \"UsdPrimvarReader_", type, "\"\n",
                    "            string inputs:varname = \"", variable, "\"\n            ", type,
                    " outputs:result\n        }\n");
  }

 public:
  std::string page_path(std::size_t page) const {
    return concat("textures/page_", page, ".", extension_of(contents_.options.texture_format));
  }

 private:
  const MeshContents& contents_;
  const TriMesh& mesh_;
  const glm::dmat3 turn_;  // to +Y up
  std::string text_;
};

}  // namespace

void write_usdz(AtomicFile& file, const MeshContents& contents, const OpenBeside&) {
  StoredZip zip(file);
  UsdLayer usd(contents);
  const std::string layer = usd.text();
  zip.add("model.usda", {reinterpret_cast<const std::uint8_t*>(layer.data()), layer.size()});
  for (std::size_t p = 0; contents.texture && p < contents.texture->pages.size(); ++p)
    zip.add(usd.page_path(p),
            encode_page(contents.texture->pages[p], contents.options.texture_format).bytes);
  zip.finish();
}

}  // namespace photohull

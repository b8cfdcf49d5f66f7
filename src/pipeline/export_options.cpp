#include "pipeline/export_options.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdlib>

#include "core/error.h"
#include "core/option_word.h"
#include "io/mesh/mesh_writers.h"
#include "pipeline/texture_stage.h"
#include "texture/texture_mesh.h"

namespace photohull::pipeline {
namespace {

constexpr double kMostTextureDetail = 4;

Words texture_words(TextureChoice& texture) {
  return {[&texture] {
            if (texture.off) return std::string("off");
            return texture.edge ? concat(texture.edge) : std::string("auto");
          },
          [&texture](const std::string& text) {
            TextureChoice read;
            read.detail = texture.detail;
            read.off = text == "off";
            if (!read.off && text != "auto") {
              char* end = nullptr;
              const long edge = std::strtol(text.c_str(), &end, 10);
              if (!std::isdigit(text[0]) || *end != 0 || edge < kLeastTextureEdge ||
                  edge > kMostTextureEdge || !std::has_single_bit(unsigned(edge)))
                return false;
              read.edge = int(edge);
            }
            texture = read;
            return true;
          }};
}

bool exports(const ReconstructOptions& o, bool (*fits)(const MeshWriter& writer)) {
  return std::ranges::any_of(o.exports, [&](const std::string& format) {
    return fits(find_mesh_writer(option_word("export"), format));
  });
}

}  // namespace

void describe_exports(Described& to, ReconstructOptions& o) {
  std::string formats;
  for (const MeshWriter& writer : mesh_writers())
    formats += concat(formats.empty() ? "" : ", ", writer.name, " (", writer.what, ")");
  to.text("export", &o.exports,
          "a format that the mesh is written in, too (repeatable): " + formats);
  to.text("texture", texture_words(o.texture),
          "texture of exported files that hold one: as fine as the photographs (auto), one image "
          "with edges of this many texels at most, or off: colours at vertices")
      .expects =
      concat("auto, off, or a power of two from ", kLeastTextureEdge, " to ", kMostTextureEdge);
  to.number("texture_detail", &o.texture.detail, from_to(0, kMostTextureDetail), "",
            "contrast of what is as fine as two texels, beside which 1 is the best photograph's: "
            "more sharpens the texture, and its noise");
  describe(to, o.mesh_files);
}

void check_exports(const ReconstructOptions& o) {
  for (const std::string& format : o.exports) find_mesh_writer(option_word("export"), format);
  const MeshFileOptions& files = o.mesh_files;
  const auto fail = [](const std::string& option, const char* lacks, const char* give) {
    throw UsageError(concat(option, ": no file that is written ", lacks, "; give ",
                            option_word("export", "glb"), give));
  };
  if (o.texture.edge && !makes_texture(o))
    fail(option_word("texture", o.texture.edge), "holds a texture", " or obj");
  if (o.texture.detail != TextureChoice().detail && !makes_texture(o))
    fail(option_word("texture_detail", o.texture.detail), "holds a texture", " or obj");
  if (files.texture_format != MeshFileOptions().texture_format && !makes_texture(o))
    fail(option_word("texture_format", to_string(files.texture_format)), "holds a texture",
         " or obj");
  if (files.compress && !exports(o, [](const MeshWriter& w) { return w.compresses; }))
    fail(option_word("compress"), "can be compressed", "");
  if (files.unit && !exports(o, [](const MeshWriter& w) { return w.has_unit; }))
    fail(option_word("unit", to_string(*files.unit)), "has a unit of its own", ", stl or usdz");
}

}  // namespace photohull::pipeline

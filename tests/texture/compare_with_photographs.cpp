// compare_with_photographs SCENE VIEWS [--like REFERENCE] MESH... [PICTURE.png]: how much meshes'
// own colours, on their textures (.glb) or at their vertices (.ply), look like photographs, best
// such as they were not made from (docs/measurements/textures.md), or like pictures of a reference
// mesh from the same cameras. Views are indices with commas between them. Where photographs differ
// in size from those that a mesh was made from, they are compared at their own. The picture has the
// photographs on the left and the last mesh on the right.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <sstream>

#include "core/error.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "io/mesh/read_mesh.h"
#include "io/mesh/read_textured.h"
#include "pipeline/texture_stage.h"
#include "raycast/ray_scene.h"
#include "scenes.h"

namespace photohull::texture {
namespace {

constexpr int kReach = 3;                // of windows of 7 x 7 pixels
constexpr double kLeastVariance = 4e-4;  // of roots of linear light: what is plainer is not judged

struct Sums {
  double squared = 0, score = 0, contrast = 0;
  std::int64_t values = 0, windows = 0;

  void print(const std::string& name) const {
    std::printf("%-24s PSNR %.2f dB, ZNCC %.4f, contrast %.3f\n", name.c_str(),
                -10 * std::log10(squared / double(values)), score / double(windows),
                contrast / double(windows));
  }
};

/// Two pictures in sRGB, one after another in `rgb`; where the second shows nothing, `shown` is 0.
struct Pair {
  int width = 0, height = 0;
  std::vector<std::uint8_t> photograph, mesh, shown;

  double root(const std::vector<std::uint8_t>& rgb, int x, int y) const {
    const std::uint8_t* p = &rgb[3 * (std::size_t(y) * width + x)];
    return std::sqrt(0.2126 * linear_from_srgb(p[0] / 255.0) +
                     0.7152 * linear_from_srgb(p[1] / 255.0) +
                     0.0722 * linear_from_srgb(p[2] / 255.0));
  }
};

struct Likeness {
  double zncc;      ///< normalised cross-correlation
  double contrast;  ///< standard deviation of the mesh's, beside which 1 is the photograph's
};

/// Of the window around a pixel; nothing where the photograph is plain, or the mesh not all around.
std::optional<Likeness> likeness(const Pair& pair, int x, int y) {
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0, n = 0;
  for (int j = y - kReach; j <= y + kReach; ++j)
    for (int i = x - kReach; i <= x + kReach; ++i, ++n) {
      if (!pair.shown[std::size_t(j) * pair.width + i]) return std::nullopt;
      const double p = pair.root(pair.photograph, i, j), q = pair.root(pair.mesh, i, j);
      a += p;
      b += q;
      aa += p * p;
      bb += q * q;
      ab += p * q;
    }
  const double va = aa - a * a / n, vb = bb - b * b / n;
  if (va < n * kLeastVariance) return std::nullopt;
  return Likeness{(ab - a * b / n) / std::sqrt(va * std::max(vb, 1e-6 * n)),
                  std::sqrt(std::max(vb, 0.0) / va)};
}

glm::vec3 colour_of(const TexturedMesh& mesh, const Hit& hit) {
  const glm::dvec3 weights(1 - hit.u - hit.v, hit.u, hit.v);
  if (!mesh.texture.pages.empty()) return colour_at(mesh.texture, hit.triangle, weights);
  glm::vec3 colour(0);
  for (int i = 0; i < 3; ++i)
    colour += float(weights[i]) * mesh.mesh.colours[mesh.mesh.triangles[hit.triangle][i]];
  return colour;
}

/// A mesh file that pictures are drawn of.
struct Drawable {
  Drawable(const Scene& scene, const std::string& path)
      : mesh(read(scene, path)), rays(mesh.mesh) {}

  TexturedMesh mesh;
  RayScene rays;

 private:
  static TexturedMesh read(const Scene& scene, const std::string& path) {
    std::vector<PreparedView> cameras;
    for (const SourceView& view : scene.views) cameras.push_back({view.name, view.camera, {}, {}});
    if (path.ends_with(".glb")) return read_textured_glb(path, pipeline::upward_axis(cameras));
    TexturedMesh out;
    out.mesh = read_mesh(path);
    return out;
  }
};

/// Pixels in sRGB, three bytes each, and which of them show the mesh.
struct Drawn {
  std::vector<std::uint8_t> rgb, shown;
};

Drawn draw(const Drawable& drawable, const Camera& camera, int width, int height) {
  const std::size_t pixels = std::size_t(width) * height;
  Drawn out{std::vector<std::uint8_t>(3 * pixels), std::vector<std::uint8_t>(pixels)};
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = std::size_t(y) * width + x;
      const auto hit = drawable.rays.closest(camera.center(), camera.ray({double(x), double(y)}));
      out.shown[i] = hit.has_value();
      const glm::vec3 colour = hit ? colour_of(drawable.mesh, *hit) : glm::vec3(0);
      for (int c = 0; c < 3; ++c)
        out.rgb[3 * i + std::size_t(c)] = std::uint8_t(
            std::lround(255 * srgb_from_linear(std::clamp(double(colour[c]), 0.0, 1.0))));
    }
  });
  return out;
}

/// The mesh beside the photograph, or beside the reference where there is one.
Pair draw_pair(const Drawable& mesh, const Drawable* reference, const SourceView& view) {
  const ColourImage image = io::read_image(view.image);
  Drawn drawn = draw(mesh, view.camera, image.width, image.height);
  Pair out{image.width, image.height, {}, std::move(drawn.rgb), std::move(drawn.shown)};
  if (reference) {
    Drawn like = draw(*reference, view.camera, image.width, image.height);
    for (std::size_t i = 0; i < out.shown.size(); ++i) out.shown[i] &= like.shown[i];
    out.photograph = std::move(like.rgb);
    return out;
  }
  out.photograph.resize(out.mesh.size());
  for (std::size_t i = 0; i < out.shown.size(); ++i)
    std::copy_n(&image.bytes[4 * i], 3, &out.photograph[3 * i]);
  return out;
}

Sums compare(const Pair& pair) {
  Sums sums;
  for (int y = kReach; y < pair.height - kReach; ++y)
    for (int x = kReach; x < pair.width - kReach; ++x) {
      const std::size_t i = std::size_t(y) * pair.width + x;
      if (!pair.shown[i]) continue;
      for (std::size_t c = 3 * i; c < 3 * i + 3; ++c)
        sums.squared += std::pow((pair.photograph[c] - pair.mesh[c]) / 255.0, 2);
      sums.values += 3;
      if (const auto like = likeness(pair, x, y)) {
        sums.score += like->zncc;
        sums.contrast += like->contrast;
        ++sums.windows;
      }
    }
  return sums;
}

void add_picture(const Pair& pair, int width, std::vector<std::uint8_t>& rgb) {
  if (2 * pair.width != width) return;
  for (int y = 0; y < pair.height; ++y)
    for (const auto* side : {&pair.photograph, &pair.mesh}) {
      const auto row = side->begin() + std::ptrdiff_t(3) * y * pair.width;
      rgb.insert(rgb.end(), row, row + std::ptrdiff_t(3) * pair.width);
    }
}

/// The picture, rows of `width` pixels.
std::vector<std::uint8_t> compare_mesh(const Scene& scene, const std::string& indices,
                                       const std::string& path, const Drawable* reference,
                                       int& width) {
  const Drawable mesh(scene, path);
  Sums all;
  std::vector<std::uint8_t> picture;
  std::stringstream views(indices);
  for (std::string index; std::getline(views, index, ',');) {
    const Pair pair = draw_pair(mesh, reference, scene.views.at(std::size_t(std::stoi(index))));
    const Sums sums = compare(pair);
    sums.print("  view " + index);
    all.squared += sums.squared;
    all.values += sums.values;
    all.score += sums.score;
    all.contrast += sums.contrast;
    all.windows += sums.windows;
    width = 2 * pair.width;
    add_picture(pair, width, picture);
  }
  all.print(path);
  return picture;
}

int run(std::vector<std::string> arguments) {
  std::string file, like;
  if (!arguments.empty() && arguments.back().ends_with(".png")) {
    file = arguments.back();
    arguments.pop_back();
  }
  if (arguments.size() > 4 && arguments[2] == "--like") {
    like = arguments[3];
    arguments.erase(arguments.begin() + 2, arguments.begin() + 4);
  }
  if (arguments.size() < 3)
    throw UsageError("usage: SCENE VIEWS [--like REFERENCE] MESH... [PICTURE.png]");
  const Scene scene = io::load_scene(arguments[0], {});
  std::optional<Drawable> reference;
  if (!like.empty()) reference.emplace(scene, like);
  std::vector<std::uint8_t> picture;
  int width = 0;
  for (std::size_t i = 2; i < arguments.size(); ++i)
    picture =
        compare_mesh(scene, arguments[1], arguments[i], reference ? &*reference : nullptr, width);
  if (!file.empty())
    io::write_png(file, width, int(picture.size() / 3 / std::size_t(width)), 3, picture);
  return 0;
}

}  // namespace
}  // namespace photohull::texture

int main(int count, char** values) {
  try {
    return photohull::texture::run({values + 1, values + count});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

// What the report's page shows of a result with a texture.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"
#include "io/encode_jpeg.h"
#include "mesh/reduce_mesh.h"
#include "pipeline/show_result.h"
#include "raycast/closest_point.h"
#include "render/photograph.h"

namespace photohull::pipeline {
namespace {

constexpr int kQuality = 80;
constexpr double kTexelBytes = 0.35;  // of such JPEGs, to begin with
constexpr double kSmallestEdge = 64;  // texels
constexpr std::size_t kSearch = 256;  // vertices a task

/// A vertex for every place that one has on the texture, which is one image.
struct PlacedMesh {
  TriMesh mesh;
  std::vector<float> x, y;  ///< in [0, 1] from the top left
};

/// Pages side by side in rows.
struct Sheet {
  explicit Sheet(std::size_t pages)
      : columns(int(std::ceil(std::sqrt(double(pages))))),
        rows(int((pages + std::size_t(columns) - 1) / std::size_t(columns))) {}
  glm::ivec2 cell(std::size_t page) const { return {int(page) % columns, int(page) / columns}; }
  int columns, rows;
};

PlacedMesh placed(const TexturedMesh& textured, const Sheet& sheet) {
  const TriMesh& mesh = textured.mesh;
  const MeshTexture& texture = textured.texture;
  PlacedMesh out;
  out.mesh.origin = mesh.origin;
  std::vector<std::vector<std::uint32_t>> of_vertex(mesh.positions.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const glm::vec2 cell(sheet.cell(texture.page[t]));
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t vertex = mesh.triangles[t][c];
      const glm::vec2 place =
          (cell + texture.corners[t][c]) / glm::vec2(float(sheet.columns), float(sheet.rows));
      std::vector<std::uint32_t>& known = of_vertex[vertex];
      const auto same = std::ranges::find_if(
          known, [&](std::uint32_t v) { return out.x[v] == place.x && out.y[v] == place.y; });
      if (same != known.end()) {
        triangle[c] = *same;
        continue;
      }
      triangle[c] = std::uint32_t(out.mesh.positions.size());
      known.push_back(triangle[c]);
      out.mesh.positions.push_back(mesh.positions[vertex]);
      out.x.push_back(place.x);
      out.y.push_back(place.y);
    }
    out.mesh.triangles.push_back(triangle);
  }
  return out;
}

/// For each vertex of the one mesh the nearest of the other.
std::vector<std::uint32_t> nearest_vertices(const TriMesh& mesh, const TriMesh& other) {
  const ClosestPoint closest(other);
  std::vector<std::uint32_t> found(mesh.positions.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, found.size(), kSearch),
                    [&](const auto& range) {
                      std::uint32_t hint = 0;
                      for (std::size_t v = range.begin(); v < range.end(); ++v) {
                        const NearestPoint nearest = closest.nearest(mesh.world(v), hint);
                        hint = nearest.triangle;
                        int corner = 0;
                        for (int c = 1; c < 3; ++c)
                          if (nearest.weights[c] > nearest.weights[corner]) corner = c;
                        found[v] = other.triangles[hint][std::size_t(corner)];
                      }
                    });
  return found;
}

/// All pages in one image.
ColourImage joined(const std::vector<RgbImage>& pages, const Sheet& sheet) {
  const int width = pages.front().width, height = pages.front().height;
  ColourImage out;
  out.width = sheet.columns * width;
  out.height = sheet.rows * height;
  out.bytes.assign(std::size_t(out.width) * std::size_t(out.height) * 4, 255);
  for (std::size_t p = 0; p < pages.size(); ++p) {
    PHOTOHULL_CHECK(pages[p].width == width && pages[p].height == height);
    const glm::ivec2 corner = sheet.cell(p) * glm::ivec2(width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        std::copy_n(&pages[p].rgb[3 * (std::size_t(y) * std::size_t(width) + std::size_t(x))], 3,
                    &out.bytes[4 * (std::size_t(corner.y + y) * std::size_t(out.width) +
                                    std::size_t(corner.x + x))]);
  }
  return out;
}

/// As large as it may be.
std::vector<std::uint8_t> texture_jpeg(const ColourImage& image) {
  const double longest = std::max(image.width, image.height);
  double edge = std::min(
      longest, longest * std::sqrt(double(kTextureBytes) /
                                   (kTexelBytes * double(image.width) * double(image.height))));
  for (;;) {
    const double scale = edge / longest;
    const int width = std::max(1, int(std::lround(scale * image.width)));
    const int height = std::max(1, int(std::lround(scale * image.height)));
    const RgbImage small = render::cut_photograph(image, -0.5, -0.5, scale, width, height);
    std::vector<std::uint8_t> jpeg = io::encode_jpeg(width, height, small.rgb, kQuality);
    if (jpeg.size() <= kTextureBytes || edge <= kSmallestEdge) return jpeg;
    edge = std::max(kSmallestEdge,
                    0.95 * edge * std::sqrt(double(kTextureBytes) / double(jpeg.size())));
  }
}

}  // namespace

page::Shown show_textured(const TexturedMesh& textured, const TriMesh& uniform,
                          const SeenVertices& seen, std::span<const PreparedView> views) {
  constexpr float kNotKnown = std::numeric_limits<float>::quiet_NaN();
  const Sheet sheet(textured.texture.pages.size());
  PlacedMesh placed_mesh = placed(textured, sheet);
  TriMesh& mesh = placed_mesh.mesh;
  SeenVertices shown_seen;
  for (const std::uint32_t v : nearest_vertices(mesh, uniform)) {
    const bool known = v < seen.views.size();
    shown_seen.views.push_back(known ? seen.views[v] : kNotKnown);
    shown_seen.disagreement.push_back(known ? seen.disagreement[v] : kNotKnown);
    if (!uniform.confidence.empty()) mesh.confidence.push_back(uniform.confidence[v]);
  }
  mesh = reduce_mesh(mesh, kShownTriangles,
                     {&shown_seen.views, &shown_seen.disagreement, &placed_mesh.x, &placed_mesh.y});
  std::vector<glm::vec2> places;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    places.emplace_back(placed_mesh.x[v], placed_mesh.y[v]);
  page::Shown shown = show_views(views);
  shown.model = page::encode_model(mesh, layers_of(mesh, std::move(shown_seen)), places);
  shown.texture = texture_jpeg(joined(textured.texture.pages, sheet));
  return shown;
}

}  // namespace photohull::pipeline

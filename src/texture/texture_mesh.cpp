// After V. Lempitsky, D. Ivanov, "Seamless mosaicing of image-based texture maps", CVPR 2007
// [LempitskyIvanov07], and M. Waechter, N. Moehrle, M. Goesele, "Let there be color! Large-scale
// texturing of 3D reconstructions", ECCV 2014 [Waechter14].
#include "texture/texture_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <vector>

#include "core/error.h"
#include "core/option_word.h"
#include "texture/canvas.h"
#include "texture/charts.h"
#include "texture/face_views.h"
#include "texture/label_faces.h"
#include "texture/pack.h"
#include "texture/paint_page.h"
#include "texture/seams.h"
#include "texture/surface.h"
#include "texture/view_pixels.h"

namespace photohull {
namespace texture {
namespace {

constexpr double kSeamPrice = 0.005;  // of the mesh's diagonal
constexpr double kLeastScale = 1.0 / 64;
constexpr int kLeastPageEdge = 1024;  // where memory is scarce

using Neighbours = std::vector<std::array<std::uint32_t, 3>>;

double diagonal_of(const TriMesh& mesh) {
  glm::vec3 low(1e30f), high(-1e30f);
  for (const glm::vec3& p : mesh.positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  return glm::distance(glm::dvec3(low), glm::dvec3(high));
}

/// Mean over the triangles' sides.
double mean_side(const TriMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    for (int i = 0; i < 3; ++i)
      sum += glm::distance(mesh.positions[t[i]], mesh.positions[t[(i + 1) % 3]]);
  return sum / (3.0 * double(mesh.triangles.size()));
}

/// The axis that the triangle faces most.
int axis_of(const glm::dvec3& area) {
  int k = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(area[i]) > std::abs(area[k])) k = i;
  return 2 * k + (area[k] < 0 ? 1 : 0);
}

struct Atlas {
  double scale = 1;
  Planes planes;
  std::unique_ptr<ViewSources> sources;
  FaceViews seen;
  std::vector<Chart> charts;
  glm::ivec2 page{0};
  std::uint32_t pages = 0;  // 0: a chart is larger than a page
  double shrink = 1;        // that the scale needs for all to fit; 1: all does
};

/// `fill_texel`: world units, of what no photograph shows.
Planes make_planes(const TriMesh& mesh, std::span<const PreparedView> views, double scale,
                   const std::vector<std::int32_t>& labels, double fill_texel) {
  Planes planes;
  for (const PreparedView& view : views)
    planes.projectors.emplace_back(scaled_camera(view, scale), mesh.origin);
  planes.views = views.size();
  for (int axis = 0; axis < Projector::kAxes; ++axis)
    planes.projectors.emplace_back(axis, fill_texel / scale);
  for (std::size_t f = 0; f < labels.size(); ++f)
    planes.of_face.push_back(labels[f] == kUnseen
                                 ? std::uint32_t(views.size()) + axis_of(double_area(mesh, f))
                                 : std::uint32_t(labels[f]));
  return planes;
}

std::vector<glm::ivec2> sizes_of(std::span<const Chart> charts) {
  std::vector<glm::ivec2> sizes;
  for (const Chart& chart : charts) sizes.push_back(chart.size);
  return sizes;
}

/// What the work may take: a third for maps of photographs, a third for charts, a third for a page.
struct Shares {
  std::int64_t maps, canvas_texels;
  int page_edge;
};

Shares shares_of(const TextureOptions& options) {
  const std::int64_t third = options.bytes / 3;
  int edge = options.edge ? options.edge : options.page_edge;
  if (!options.edge)
    while (edge > kLeastPageEdge && kPageBytes * edge * edge > third) edge /= 2;
  return {third, third / kCanvasBytes, edge};
}

/// Charts on pages, at a scale.
Atlas lay_out(const TriMesh& mesh, const Neighbours& neighbours,
              std::span<const PreparedView> views, double scale, double fill_texel,
              const TextureOptions& options, Progress& progress) {
  const Shares shares = shares_of(options);
  const int edge = shares.page_edge;
  Atlas atlas;
  atlas.scale = scale;
  atlas.sources = std::make_unique<ViewSources>(mesh, views, scale, shares.maps);
  atlas.seen = find_face_views(mesh, views, *atlas.sources, progress);
  const std::vector<std::int32_t> labels = label_faces(mesh, neighbours, atlas.seen, views.size(),
                                                       kSeamPrice * diagonal_of(mesh), progress);
  atlas.planes = make_planes(mesh, views, scale, labels, fill_texel);
  atlas.charts = make_charts(mesh, neighbours, atlas.planes, edge, progress);
  int largest = 0;
  for (const Chart& chart : atlas.charts) largest = std::max({largest, chart.size.x, chart.size.y});
  if (largest > edge) {
    atlas.shrink = 0.9 * edge / largest;
    return atlas;
  }
  const Packed packed = pack(sizes_of(atlas.charts), edge);
  if (options.edge && packed.pages > 1) atlas.shrink = std::min(0.9, std::sqrt(1.0 / packed.pages));
  atlas.page = packed.page;
  atlas.pages = packed.pages;
  for (std::size_t c = 0; c < atlas.charts.size(); ++c) {
    atlas.charts[c].page = packed.on[c];
    atlas.charts[c].place = packed.place[c];
  }
  return atlas;
}

void set_corners(const TriMesh& mesh, const Atlas& atlas, MeshTexture& texture) {
  texture.page.resize(mesh.triangles.size());
  texture.corners.resize(mesh.triangles.size());
  for (const Chart& chart : atlas.charts)
    for (const std::uint32_t face : chart.faces) {
      const FaceInImage seen = on_chart(mesh, atlas.planes, chart, face);
      texture.page[face] = chart.page;
      for (int i = 0; i < 3; ++i)
        texture.corners[face][std::size_t(i)] =
            glm::vec2((seen.at(i) + glm::dvec2(chart.place) + 0.5) / glm::dvec2(atlas.page));
    }
}

void report_on(const TriMesh& mesh, const Atlas& atlas, std::span<const Seam> seams,
               TextureReport& report) {
  report.pages = atlas.pages;
  report.width = atlas.page.x;
  report.height = atlas.page.y;
  report.scale = atlas.scale;
  report.charts = std::int64_t(atlas.charts.size());
  std::vector<std::uint8_t> used(atlas.planes.views, 0);
  double area = 0, unseen = 0;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const double size = glm::length(double_area(mesh, f));
    area += size;
    if (atlas.seen.clear[f])
      used[atlas.planes.of_face[f]] = 1;
    else
      unseen += size;
  }
  report.views = std::count(used.begin(), used.end(), 1);
  report.unseen_share = area > 0 ? unseen / area : 1;
  for (const Seam& seam : seams)
    report.seam_length +=
        glm::distance(mesh.positions[seam.vertices[0]], mesh.positions[seam.vertices[1]]);
}

void check(const TriMesh& mesh, const TextureOptions& options) {
  PHOTOHULL_CHECK(std::has_single_bit(unsigned(options.page_edge)));
  if (mesh.triangles.empty()) throw Error("a mesh without triangles takes no texture");
  if (options.edge != 0 &&
      (options.edge < kLeastTextureEdge || !std::has_single_bit(unsigned(options.edge))))
    throw UsageError(concat(option_word("texture", options.edge),
                            ": its edge must be a power of two, ", kLeastTextureEdge, " or more"));
}

}  // namespace
}  // namespace texture

TextureResult texture_mesh(const TriMesh& mesh, const TriMesh& coloured,
                           std::span<const PreparedView> views, const TextureOptions& options,
                           Progress& progress) {
  using namespace texture;
  check(mesh, options);
  PHOTOHULL_CHECK(!views.empty());
  PHOTOHULL_CHECK_OP(coloured.colours.size(), ==, coloured.positions.size());
  const Neighbours neighbours = neighbours_of(mesh);
  const double fill_texel = std::max(mean_side(coloured), diagonal_of(mesh) / 2048);
  double scale = 1;
  Atlas atlas = lay_out(mesh, neighbours, views, scale, fill_texel, options, progress);
  while (atlas.shrink < 1) {
    scale *= atlas.shrink;
    if (scale < kLeastScale)
      throw Error(concat("the charts of the texture do not fit onto a page; give ",
                         option_word("texture"), " a larger edge"));
    atlas = lay_out(mesh, neighbours, views, scale, fill_texel, options, progress);
  }
  progress.update(0.5);
  const FillColour fill(coloured);
  const std::vector<Seam> seams = find_seams(mesh, neighbours, atlas.planes.of_face);
  TextureResult out;
  report_on(mesh, atlas, seams, out.report);
  std::int64_t most_at_once = 0;
  for (std::uint32_t page = 0; page < atlas.pages; ++page) {
    progress.update(0.6 + 0.4 * page / atlas.pages);
    const PagePlan plan(mesh, atlas.planes, atlas.charts, seams, page, atlas.page);
    PaintedPage painted =
        paint_page({mesh, *atlas.sources, atlas.planes, atlas.seen, atlas.charts, fill,
                    options.detail, options.noise, shares_of(options).canvas_texels},
                   plan, progress);
    most_at_once = std::max(most_at_once, painted.most_at_once);
    out.report.texels += painted.texels;
    out.report.filled += painted.filled;
    out.texture.pages.push_back(std::move(painted.page));
  }
  out.report.bytes = atlas.sources->bytes() + most_at_once * kCanvasBytes +
                     kPageBytes * std::int64_t(atlas.page.x) * atlas.page.y;
  set_corners(mesh, atlas, out.texture);
  return out;
}

}  // namespace photohull

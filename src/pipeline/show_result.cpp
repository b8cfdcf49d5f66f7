#include "pipeline/show_result.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "io/encode_jpeg.h"
#include "mesh/reduce_mesh.h"
#include "render/photograph.h"

namespace photohull::pipeline {
namespace {

constexpr double kLargestEdge = 400, kSmallestEdge = 48;  // pixels of pictures
constexpr int kQuality = 78;
constexpr double kPixelBytes = 0.2;         // of such JPEGs, to begin with
constexpr double kMostDisagreement = 0.25;  // of full scale, square roots of linear light
constexpr double kMostViews = 254;          // one step a view

std::vector<std::uint8_t> picture(const ColourImage& image, double edge) {
  const double scale = std::min(1.0, edge / std::max(image.width, image.height));
  const int width = std::max(1, int(std::lround(scale * image.width)));
  const int height = std::max(1, int(std::lround(scale * image.height)));
  const RgbImage small = render::cut_photograph(image, 0, 0, scale, width, height);
  return io::encode_jpeg(width, height, small.rgb, kQuality);
}

/// The views that get a picture, evenly among all.
std::vector<int> pictured(int views) {
  std::vector<int> chosen;
  const int count = std::min(views, kMostPictures);
  for (int i = 0; i < count; ++i) chosen.push_back(int(std::int64_t(i) * views / count));
  return chosen;
}

/// As large as all of them may be together.
std::vector<std::vector<std::uint8_t>> pictures(std::span<const PreparedView> views,
                                                std::span<const int> which) {
  double pixels = 0;  // of pictures with an edge of one pixel
  for (const int i : which) {
    const ColourImage& image = views[std::size_t(i)].image;
    const double a = image.width, b = image.height;
    pixels += std::min(a, b) / std::max(a, b);
  }
  double edge = std::sqrt(double(kPictureBytes) / (kPixelBytes * std::max(pixels, 1e-9)));
  for (;;) {
    edge = std::clamp(edge, kSmallestEdge, kLargestEdge);
    std::vector<std::vector<std::uint8_t>> made(which.size());
    tbb::parallel_for(std::size_t(0), which.size(), [&](std::size_t k) {
      made[k] = picture(views[std::size_t(which[k])].image, edge);
    });
    std::size_t bytes = 0;
    for (const std::vector<std::uint8_t>& jpeg : made) bytes += jpeg.size();
    if (bytes <= kPictureBytes || edge <= kSmallestEdge) return made;
    edge *= 0.95 * std::sqrt(double(kPictureBytes) / double(bytes));
  }
}

}  // namespace

page::Shown show_result(const TriMesh& mesh, SeenVertices seen,
                        std::span<const PreparedView> views) {
  constexpr float kNotKnown = std::numeric_limits<float>::quiet_NaN();
  seen.views.resize(mesh.positions.size(), kNotKnown);
  seen.disagreement.resize(mesh.positions.size(), kNotKnown);
  page::Shown shown;
  page::Model model;
  tbb::parallel_invoke([&] { shown = show_views(views); },
                       [&] {
                         const TriMesh reduced =
                             reduce_mesh(mesh, kShownTriangles, {&seen.views, &seen.disagreement});
                         model = page::encode_model(reduced, layers_of(reduced, std::move(seen)));
                       });
  shown.model = std::move(model);
  return shown;
}

std::vector<page::Layer> layers_of(const TriMesh& mesh, SeenVertices seen) {
  std::vector<page::Layer> layers;
  if (!mesh.confidence.empty()) layers.push_back({"confidence", mesh.confidence, 1});
  layers.push_back({"views", std::move(seen.views), kMostViews});
  layers.push_back({"disagreement", std::move(seen.disagreement), kMostDisagreement});
  return layers;
}

page::Shown show_views(std::span<const PreparedView> views) {
  page::Shown shown;
  for (const PreparedView& view : views) shown.views.push_back({view.name, view.camera, {}});
  const std::vector<int> which = pictured(int(views.size()));
  std::vector<std::vector<std::uint8_t>> made = pictures(views, which);
  for (std::size_t k = 0; k < which.size(); ++k)
    shown.views[std::size_t(which[k])].jpeg = std::move(made[k]);
  return shown;
}

}  // namespace photohull::pipeline

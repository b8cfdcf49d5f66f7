// compare_with_truth SCENE MESH.glb...: how many texels of textures differ from the true colour of
// the surface, on scenes whose true mesh gt.ply is known (docs/guide/textures.md). The true colour
// at the point of gt.ply nearest to a texel is the median over all photographs that show it well
// inside of all outlines, by rays against gt.ply and nothing that photohull found.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <optional>

#include "core/error.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "io/mesh/read_mesh.h"
#include "pipeline/texture_stage.h"
#include "raycast/closest_point.h"
#include "raycast/ray_scene.h"
#include "read_textured.h"
#include "scenes.h"

namespace photohull::texture {
namespace {

constexpr double kLeastCosine = 0.35;
constexpr double kAround = 3;   // pixels in which there must be no outline
constexpr double kDeepest = 3;  // that depths may differ by there, beside the slope's own
constexpr std::size_t kLeastViews = 3;
constexpr double kApart = 0.2;  // of full scale, sRGB, in any channel
constexpr int kStep = 3;        // texels along each side, one of which is looked at

class Truth {
 public:
  Truth(const Scene& scene, TriMesh mesh)
      : scene_(scene), mesh_(std::move(mesh)), rays_(mesh_), nearest_(mesh_) {
    for (const SourceView& view : scene.views) images_.push_back(io::read_image(view.image));
  }

  /// sRGB, [0, 1]; nothing where too few photographs show it.
  std::optional<glm::dvec3> colour(const glm::dvec3& point) const {
    const NearestPoint near = nearest_.nearest(point);
    const auto& [a, b, c] = mesh_.triangles[near.triangle];
    const glm::dvec3 normal = glm::normalize(
        glm::cross(mesh_.world(b) - mesh_.world(a), mesh_.world(c) - mesh_.world(a)));
    std::array<std::vector<double>, 3> seen;
    for (std::size_t v = 0; v < images_.size(); ++v)
      if (const auto pixel = pixel_of(near.point, normal, scene_.views[v].camera)) {
        const glm::dvec3 value = sample(images_[v], *pixel);
        for (int i = 0; i < 3; ++i) seen[std::size_t(i)].push_back(value[i]);
      }
    if (seen[0].size() < kLeastViews) return std::nullopt;
    glm::dvec3 median;
    for (int i = 0; i < 3; ++i) {
      auto& values = seen[std::size_t(i)];
      const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
      std::nth_element(values.begin(), middle, values.end());
      median[i] = *middle;
    }
    return median;
  }

  /// From the true surface, world units.
  double distance(const glm::dvec3& point) const {
    return glm::distance(nearest_.nearest(point).point, point);
  }

 private:
  std::optional<glm::dvec2> pixel_of(const glm::dvec3& point, const glm::dvec3& normal,
                                     const Camera& camera) const {
    const glm::dvec3 way = camera.center() - point, p = camera.to_camera(point);
    const double distance = glm::length(way), cosine = glm::dot(way, normal) / distance;
    if (!(cosine > kLeastCosine) || !(p.z > 0)) return std::nullopt;
    const glm::dvec2 pixel = *camera.project(point);
    const Intrinsics& k = camera.intrinsics;
    if (!(pixel.x > kAround && pixel.y > kAround && pixel.x < k.width - 1 - kAround &&
          pixel.y < k.height - 1 - kAround))
      return std::nullopt;
    const double footprint = p.z / k.fx;
    const double slope = std::sqrt(1 - cosine * cosine) / cosine;
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i) {
        const glm::dvec3 ray = camera.ray(pixel + kAround * glm::dvec2(i, j));
        const auto hit = rays_.closest(camera.center(), ray);
        if (!hit) return std::nullopt;
        const double depth = camera.to_camera(camera.center() + hit->t * ray).z;
        if (std::abs(depth - p.z) > footprint * kAround * (1.5 * slope + kDeepest))
          return std::nullopt;
      }
    return pixel;
  }

  static glm::dvec3 sample(const ColourImage& image, const glm::dvec2& pixel) {
    const glm::ivec2 base(glm::floor(pixel));
    const glm::dvec2 f = pixel - glm::dvec2(base);
    glm::dvec3 sum(0);
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i) {
        const std::uint8_t* p =
            &image.bytes[4 * (std::size_t(base.y + j) * image.width + std::size_t(base.x + i))];
        sum += (i ? f.x : 1 - f.x) * (j ? f.y : 1 - f.y) * glm::dvec3(p[0], p[1], p[2]) / 255.0;
      }
    return sum;
  }

  const Scene& scene_;
  TriMesh mesh_;
  RayScene rays_;
  ClosestPoint nearest_;
  std::vector<ColourImage> images_;
};

struct Counts {
  std::atomic<std::int64_t> known{0}, unknown{0}, apart{0}, squared{0};  // squared: in 1e-9
  std::mutex mutex;
  std::vector<double> off;  // world units: how far the mesh is off where colours are apart
};

void look_at_triangle(const TexturedMesh& mesh, std::size_t face, const Truth& truth,
                      Counts& counts) {
  const RgbImage& page = mesh.texture.pages[mesh.texture.page[face]];
  std::array<glm::dvec2, 3> at;
  for (std::size_t i = 0; i < 3; ++i)
    at[i] = glm::dvec2(mesh.texture.corners[face][i]) * glm::dvec2(page.width, page.height) - 0.5;
  const glm::dvec2 u = at[1] - at[0], v = at[2] - at[0];
  const double area = u.x * v.y - u.y * v.x;
  if (std::abs(area) < 1e-9) return;
  const glm::dvec2 low = glm::min(at[0], glm::min(at[1], at[2])),
                   high = glm::max(at[0], glm::max(at[1], at[2]));
  for (int y = int(std::ceil(low.y)); y <= high.y; ++y)
    for (int x = int(std::ceil(low.x)); x <= high.x; ++x) {
      if (x % kStep || y % kStep) continue;
      const glm::dvec2 p = glm::dvec2(x, y) - at[0];
      const double b = (p.x * v.y - p.y * v.x) / area, c = (u.x * p.y - u.y * p.x) / area;
      if (b < 0 || c < 0 || b + c > 1) continue;
      const auto& t = mesh.mesh.triangles[face];
      const glm::dvec3 point = (1 - b - c) * mesh.mesh.world(t[0]) + b * mesh.mesh.world(t[1]) +
                               c * mesh.mesh.world(t[2]);
      const auto colour = truth.colour(point);
      if (!colour) {
        ++counts.unknown;
        continue;
      }
      const std::uint8_t* rgb = &page.rgb[3 * (std::size_t(y) * page.width + std::size_t(x))];
      const glm::dvec3 d = glm::dvec3(rgb[0], rgb[1], rgb[2]) / 255.0 - *colour;
      ++counts.known;
      if (std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) > kApart) {
        ++counts.apart;
        const std::lock_guard lock(counts.mutex);
        counts.off.push_back(truth.distance(point));
      }
      counts.squared += std::int64_t(1e9 * glm::dot(d, d) / 3);
    }
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() < 2) throw UsageError("usage: SCENE MESH.glb...");
  const Scene scene = io::load_scene(arguments[0], {});
  const Truth truth(scene, read_mesh(arguments[0] + "/gt.ply"));
  std::vector<PreparedView> cameras;
  for (const SourceView& view : scene.views) cameras.push_back({view.name, view.camera, {}, {}});
  for (std::size_t m = 1; m < arguments.size(); ++m) {
    const TexturedMesh mesh = read_textured(arguments[m], pipeline::upward_axis(cameras));
    Counts counts;
    tbb::parallel_for(std::size_t(0), mesh.mesh.triangles.size(),
                      [&](std::size_t f) { look_at_triangle(mesh, f, truth, counts); });
    const double known = double(std::max<std::int64_t>(counts.known, 1));
    std::printf(
        "%s: %lld texels, of %lld more the true colour is not known; %.4f %% differ by more "
        "than %.1f, PSNR %.2f dB\n",
        arguments[m].c_str(), static_cast<long long>(counts.known),
        static_cast<long long>(counts.unknown), 100 * double(counts.apart) / known, kApart,
        -10 * std::log10(std::max(1e-9 * double(counts.squared) / known, 1e-12)));
    std::ranges::sort(counts.off);
    if (!counts.off.empty())
      std::printf("where they do, the mesh is off by %.2g units (median), at most %.2g\n",
                  counts.off[counts.off.size() / 2], counts.off.back());
  }
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

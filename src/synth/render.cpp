#include "synth/render.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "synth/random.h"

namespace photohull::synth {
namespace {

constexpr int kRaysAtOnce = 200000;  ///< whose hits wait for the maps' answers

/// Pixels of the frame that the object can touch, ends excluded.
struct Frame {
  int x0, y0, x1, y1;
};

Frame find_frame(const Surface& surface, const LensCamera& lens) {
  const Intrinsics& k = lens.camera.intrinsics;
  Frame whole = {0, 0, k.width, k.height};
  // A lens may bend an edge outward between two vertices.
  if (lens.distortion.model != DistortionModel::kNone) return whole;
  glm::dvec2 low(INFINITY), high(-INFINITY);
  for (std::size_t i = 0; i < surface.mesh.positions.size(); ++i) {
    const auto p = lens.project(surface.mesh.world(i));
    if (!p) return whole;
    low = min(low, *p), high = max(high, *p);
  }
  const auto clamped = [](double value, int last) {
    return int(std::clamp(value, 0.0, double(last)));
  };
  return {clamped(std::floor(low.x) - 1, k.width), clamped(std::floor(low.y) - 1, k.height),
          clamped(std::ceil(high.x) + 2, k.width), clamped(std::ceil(high.y) + 2, k.height)};
}

/// Rays of a run of pixels, what they met and, where maps were asked, how it is lit.
struct Traced {
  std::vector<Ray> rays;
  std::vector<Hit> hits;
  LightShares shares;
};

class RowRenderer {
 public:
  static constexpr int kBlock = 16;  ///< pixels whose rays are traced at once

  RowRenderer(const Surface& surface, const Shading& shading, const LensCamera& lens,
              std::size_t view, int samples, std::uint64_t seed)
      : surface_(surface),
        shading_(shading),
        lens_(lens),
        frame_(shading.fine_background()
                   ? Frame{0, 0, lens.camera.intrinsics.width, lens.camera.intrinsics.height}
                   : find_frame(surface, lens)),
        to_world_(transpose(lens.camera.cam_from_world.rotation)),
        eye_(lens.camera.center()),
        view_(view),
        n_(samples),
        seed_(seed) {}

  bool touched(int y) const { return y >= frame_.y0 && y < frame_.y1 && frame_.x0 < frame_.x1; }

  /// All rays of a row that is touched.
  void trace_row(int y, Traced& traced) const {
    trace(frame_.x0, frame_.x1, y, edge(y - 0.5), edge(y + 0.5), traced);
  }

  /// `ready`: the row's rays, where they have been traced before.
  void render(int y, Picture& picture, const Traced* ready) const {
    std::vector<Ray> centers;
    for (int x = 0; x < picture.width; ++x) centers.push_back(ray(undistorted({x, y})));
    std::vector<Hit> hits(centers.size());
    if (touched(y))
      surface_.rays->closest(std::span(centers).subspan(frame_.x0, frame_.x1 - frame_.x0),
                             std::span(hits).subspan(frame_.x0, frame_.x1 - frame_.x0));
    for (int x = 0; x < picture.width; ++x) {
      const std::size_t i = std::size_t(y) * picture.width + x;
      write_center(centers[x], hits[x], i, picture);
    }
    if (touched(y)) {
      if (ready)
        shade(frame_.x0, frame_.x1, y, *ready, picture);
      else
        render_blocks(y, picture);
    }
    if (shading_.fine_background()) return;
    for (int x = 0; x < picture.width; ++x) {
      const std::size_t i = std::size_t(y) * picture.width + x;
      // The background has no edges finer than a pixel: one look is enough.
      if (picture.coverage[i] < 1)
        picture.colour[i] += (1 - picture.coverage[i]) * shading_.background(centers[x], view_);
    }
  }

 private:
  /// Positions on the plane z = 1 along a line between two rows of pixels, from the left border of
  /// the first pixel to the right one of the last.
  std::vector<glm::dvec2> edge(double y) const {
    std::vector<glm::dvec2> points;
    for (int x = 0; x <= lens_.camera.intrinsics.width; ++x)
      points.push_back(undistorted({x - 0.5, y}));
    return points;
  }

  glm::dvec2 undistorted(const glm::dvec2& pixel) const {
    const auto p = lens_.undistorted(pixel);
    if (!p) throw Error("degradations: the lens folds over within the frame; lower k1, k2");
    return *p;
  }

  /// t along the ray is the depth.
  Ray ray(const glm::dvec2& p) const { return {eye_, to_world_ * glm::dvec3(p, 1.0)}; }

  void sample_rays(int x, int y, const std::vector<glm::dvec2>& above,
                   const std::vector<glm::dvec2>& below, Ray* rays) const {
    Random random(seed_, view_, std::uint64_t(y) << 32 | std::uint64_t(x));
    for (int j = 0; j < n_; ++j)
      for (int i = 0; i < n_; ++i) {
        const std::uint64_t bits = random.bits();
        const double u = (i + double(bits >> 32) * 0x1p-32) / n_;
        const double v = (j + double(bits & 0xffffffffu) * 0x1p-32) / n_;
        // Within a pixel the lens is as good as bilinear.
        *rays++ = ray((1 - v) * ((1 - u) * above[x] + u * above[x + 1]) +
                      v * ((1 - u) * below[x] + u * below[x + 1]));
      }
  }

  void render_blocks(int y, Picture& picture) const {
    thread_local Traced block;
    const std::vector<glm::dvec2> above = edge(y - 0.5), below = edge(y + 0.5);
    for (int x = frame_.x0; x < frame_.x1; x += kBlock) {
      const int last = std::min(x + kBlock, frame_.x1);
      trace(x, last, y, above, below, block);
      shade(x, last, y, block, picture);
    }
  }

  /// The rays of the pixels from `first` to before `last`.
  void trace(int first, int last, int y, const std::vector<glm::dvec2>& above,
             const std::vector<glm::dvec2>& below, Traced& traced) const {
    const std::size_t each = std::size_t(n_ * n_), count = each * std::size_t(last - first);
    traced.rays.resize(count), traced.hits.resize(count);
    for (int x = first; x < last; ++x)
      sample_rays(x, y, above, below, traced.rays.data() + each * std::size_t(x - first));
    surface_.rays->closest(traced.rays, traced.hits);
  }

  /// Light and coverage of these pixels, all at once.
  void shade(int first, int last, int y, const Traced& traced, Picture& picture) const {
    thread_local std::vector<glm::vec3> light;
    const std::size_t each = std::size_t(n_ * n_);
    light.resize(traced.rays.size());
    shading_.shade(traced.rays, traced.hits, traced.shares, light);
    for (int x = first; x < last; ++x) {
      glm::vec3 sum(0);
      int covered = 0;
      const std::size_t start = each * std::size_t(x - first);
      for (std::size_t i = start; i < start + each; ++i)
        if (traced.hits[i])
          sum += light[i], ++covered;
        else if (shading_.fine_background())
          sum += shading_.background(traced.rays[i], view_);
      const std::size_t pixel = std::size_t(y) * picture.width + x;
      picture.colour[pixel] = sum / float(each);
      picture.coverage[pixel] = float(covered) / float(each);
    }
  }

  void write_center(const Ray& center, const Hit& hit, std::size_t i, Picture& picture) const {
    if (!hit) return;
    const glm::vec3 normal = surface_.normal(hit);
    const glm::vec3& face = surface_.face_normals[hit.triangle];
    picture.depth[i] = float(hit.t);
    picture.normal[i] = dot(glm::dvec3(face), center.direction) > 0 ? -normal : normal;
  }

  const Surface& surface_;
  const Shading& shading_;
  const LensCamera& lens_;
  Frame frame_;
  glm::dmat3 to_world_;
  glm::dvec3 eye_;
  std::size_t view_;
  int n_;
  std::uint64_t seed_;
};

/// Bands of rows: their rays from all threads, the maps' answers from this one, then the light.
void render_with_maps(const RowRenderer& rows, LightMaps& maps, int samples, Picture& picture,
                      const std::function<void()>& row_done) {
  const int height = std::max(1, kRaysAtOnce / std::max(1, picture.width * samples * samples));
  std::vector<Traced> band(static_cast<std::size_t>(height));
  for (int first = 0; first < picture.height; first += height) {
    const int last = std::min(first + height, picture.height);
    tbb::parallel_for(first, last, [&](int y) {
      if (rows.touched(y)) rows.trace_row(y, band[std::size_t(y - first)]);
    });
    for (int y = first; y < last; ++y) {
      Traced& row = band[std::size_t(y - first)];
      if (rows.touched(y)) row.shares = maps.shares(row.rays, row.hits);
    }
    tbb::parallel_for(first, last, [&](int y) {
      rows.render(y, picture, &band[std::size_t(y - first)]);
      row_done();
    });
  }
}

}  // namespace

Picture render(const Surface& surface, const Shading& shading, const LensCamera& lens,
               std::size_t view, int samples, std::uint64_t seed,
               const std::function<void()>& row_done, LightMaps* maps) {
  Picture picture;
  picture.width = lens.camera.intrinsics.width, picture.height = lens.camera.intrinsics.height;
  const std::size_t pixels = std::size_t(picture.width) * picture.height;
  picture.colour.resize(pixels);
  picture.coverage.resize(pixels);
  picture.depth.resize(pixels);
  picture.normal.resize(pixels);
  const RowRenderer rows(surface, shading, lens, view, samples, seed);
  if (maps) {
    maps->look_from(lens.camera);
    render_with_maps(rows, *maps, samples, picture, row_done);
  } else {
    tbb::parallel_for(0, picture.height, [&](int y) {
      rows.render(y, picture, nullptr);
      row_done();
    });
  }
  return picture;
}

Picture render_background(const Shading& shading, const LensCamera& lens, std::size_t view) {
  Picture picture;
  picture.width = lens.camera.intrinsics.width, picture.height = lens.camera.intrinsics.height;
  const glm::dmat3 to_world = transpose(lens.camera.cam_from_world.rotation);
  const glm::dvec3 eye = lens.camera.center();
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const auto p = lens.undistorted({x, y});
      if (!p) throw Error("degradations: the lens folds over within the frame; lower k1, k2");
      picture.colour.push_back(shading.background({eye, to_world * glm::dvec3(*p, 1.0)}, view));
    }
  return picture;
}

}  // namespace photohull::synth

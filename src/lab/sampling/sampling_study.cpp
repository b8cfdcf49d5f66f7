#include "lab/sampling/sampling_study.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/gtc/packing.hpp>
#include <memory>
#include <numbers>
#include <random>

#include "core/error.h"
#include "gpu/buffer.h"
#include "lab/sampling/study_clock.h"
#include "projtex/sample_images.h"
#include "projtex/sampler_reference.h"
#include "shared/sampling.h"

namespace photohull::projtex {
namespace {

using glm::dvec2;
using glm::dvec3;
using reference::LinearImage;

constexpr int kImageSize = 1024;  // pixels
constexpr int kBorder = 256;      // that squares' centres keep away from
constexpr double kFocal = 1500;   // pixels
constexpr double kDepth = 2000;   // voxels
constexpr double kTilt = 0.04;    // depth along a square's edge, share of the depth at its centre
constexpr double kLeastTimed = 4e-3;  // seconds; shorter runs are repeated on more squares
constexpr double kMostTimed = 32768;  // squares

PreparedView view_of(const std::function<double(int, int)>& value) {
  PreparedView view;
  view.camera.intrinsics = {kImageSize, kImageSize,       kFocal,          kFocal,
                            0,          0.5 * kImageSize, 0.5 * kImageSize};
  view.image.width = view.image.height = kImageSize;
  view.image.encoding = ColourImage::Encoding::kLinearHalf;
  for (int y = 0; y < kImageSize; ++y)
    for (int x = 0; x < kImageSize; ++x) {
      const glm::uint64 packed = glm::packHalf4x16(glm::vec4(glm::vec3(float(value(x, y))), 1.0f));
      std::uint8_t bytes[8];
      std::memcpy(bytes, &packed, 8);
      view.image.bytes.insert(view.image.bytes.end(), bytes, bytes + 8);
    }
  return view;
}

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * double(random() >> 11) * 0x1p-53;
}

/// White noise, and zones whose frequency grows from the middle to Nyquist's at the sides.
std::vector<PreparedView> test_views(std::mt19937_64& random) {
  const double middle = 0.5 * kImageSize;
  return {view_of([&](int, int) { return uniform(random, 0, 1); }), view_of([&](int x, int y) {
            const double r2 = (x - middle) * (x - middle) + (y - middle) * (y - middle);
            return 0.5 + 0.5 * std::cos(std::numbers::pi * r2 / kImageSize);
          })};
}

/// A square at a pixel with this Jacobian there; its plane is tilted, which changes depths and with
/// them the perspective over the square, not the Jacobian.
reference::PlaneSquare square_at(const dvec2& pixel, const dvec2& du, const dvec2& dv,
                                 const dvec2& tilt) {
  const dvec3 ray((pixel.x - 0.5 * kImageSize) / kFocal, (pixel.y - 0.5 * kImageSize) / kFocal, 1);
  const auto edge = [&](const dvec2& d, double slope) {
    return kDepth * (dvec3(d / kFocal, 0) + slope * ray);
  };
  return {kDepth * ray, edge(du, tilt.x), edge(dv, tilt.y)};
}

struct Squares {
  std::vector<reference::PlaneSquare> list;
  std::vector<int> view_of;
  std::vector<double> truth;
};

class Study {
 public:
  Study(gpu::Context& context, const StudyOptions& options)
      : context_(context), options_(options), random_(options.seed), views_(test_views(random_)) {
    const GridSpec grid{{0, 0, 0}, 1, {1, 1, 1}};
    for (const PreparedView& view : views_) {
      cameras_.push_back(to_grid(view.camera, grid));
      images_.push_back(reference::covered_image(view.image, view.mask, {kImageSize, kImageSize}));
    }
  }

  std::vector<StudyCell> run(Progress& progress) {
    for (const double footprint : options_.footprints)
      for (const double ratio : options_.ratios) make_squares(footprint, ratio);
    std::vector<StudyCell> cells;
    int done = 0;
    for (const Sampler sampler : kSamplers) {
      if (sampler != Sampler::kCentroid && has(sampler))
        for (const int supersample : options_.supersamples) {
          progress.check_cancelled();
          measure(sampler, supersample, cells);
        }
      progress.update(double(++done) / double(std::size(kSamplers)));
    }
    return cells;
  }

 private:
  /// Loads the images for the sampler; false where the device lacks its filter.
  bool has(Sampler sampler) {
    try {
      loaded_ = std::make_unique<SampleImages>(views_, sampler);
    } catch (const Error&) {
      if (sampler != Sampler::kHardware) throw;
      return false;
    }
    std::vector<shaders::GpuView> gpu_views;
    for (const GridCamera& camera : cameras_)
      gpu_views.push_back(to_gpu_view(camera, loaded_->size()));
    view_buffer_ = gpu::Buffer::of(gpu_views);
    return true;
  }

  void make_squares(double footprint, double ratio) {
    Squares squares;
    const double longer = footprint * std::sqrt(ratio), shorter = footprint / std::sqrt(ratio);
    for (int view = 0; view < int(views_.size()); ++view)
      for (int i = 0; i < options_.squares; ++i) {
        const double a = uniform(random_, 0, 2 * std::numbers::pi);
        const double b = uniform(random_, 0, 2 * std::numbers::pi);
        const dvec2 e(std::cos(a), std::sin(a)), n(-e.y, e.x);
        const dvec2 pixel(uniform(random_, kBorder, kImageSize - kBorder),
                          uniform(random_, kBorder, kImageSize - kBorder));
        squares.list.push_back(
            square_at(pixel, std::cos(b) * longer * e + std::sin(b) * shorter * n,
                      std::cos(b) * shorter * n - std::sin(b) * longer * e,
                      {uniform(random_, -kTilt, kTilt), uniform(random_, -kTilt, kTilt)}));
        squares.view_of.push_back(view);
        squares.truth.push_back(reference::oracle(images_[std::size_t(view)],
                                                  cameras_[std::size_t(view)], squares.list.back())
                                    .r);
      }
    squares_.push_back(std::move(squares));
  }

  std::vector<glm::vec4> sample(const gpu::Program& program, const Squares& squares,
                                std::size_t count, double& seconds) {
    std::vector<shaders::PlaneSquare> list;
    for (std::size_t i = 0; i < count; ++i) {
      const reference::PlaneSquare& s = squares.list[i % squares.list.size()];
      list.push_back({glm::vec4(s.centre, squares.view_of[i % squares.list.size()]),
                      glm::vec4(s.u, 0), glm::vec4(s.v, 0)});
    }
    const gpu::Buffer square_buffer = gpu::Buffer::of(list), samples(count * 16);
    program.set("count", int(count));
    view_buffer_.bind_storage(shaders::kViewsBinding);
    square_buffer.bind_storage(shaders::kSquaresBinding);
    samples.bind_storage(shaders::kSquareSamplesBinding);
    loaded_->bind(program);
    for (int repeat = 0; repeat < std::min(options_.repeats, 2); ++repeat)
      seconds = std::min(seconds, seconds_of(context_, [&] {
                           program.dispatch(context_, "projtex_sample_squares",
                                            gpu::group_count(count, shaders::kSquareGroup));
                         }));
    return samples.download<glm::vec4>(squares.list.size());
  }

  void measure(Sampler sampler, int supersample, std::vector<StudyCell>& cells) {
    const auto program =
        loaded_->program(context_, "projtex_sample_squares.comp.glsl", supersample);
    std::size_t at = 0;
    for (const double footprint : options_.footprints)
      for (const double ratio : options_.ratios) {
        const Squares& squares = squares_[at++];
        double seconds = 1e30;
        std::size_t count = squares.list.size();
        const std::vector<glm::vec4> found = sample(*program, squares, count, seconds);
        if (seconds < kLeastTimed && options_.repeats > 1) {
          const double more = 2 * kLeastTimed / std::max(seconds, 1e-6);
          count = std::size_t(std::min(more * double(count), std::max(kMostTimed, double(count))));
          seconds = 1e30;
          sample(*program, squares, count, seconds);
        }
        StudyCell cell{sampler, supersample, footprint, ratio, 0, 0, 1e9 * seconds / double(count)};
        std::vector<double> errors;
        for (std::size_t i = 0; i < found.size(); ++i) {
          // Samples are square roots of linear light.
          errors.push_back(std::abs(double(found[i].r) * found[i].r - squares.truth[i]));
          cell.rms += errors.back() * errors.back() / double(found.size());
        }
        std::sort(errors.begin(), errors.end());
        cell.rms = 100 * std::sqrt(cell.rms);
        cell.percentile99 = 100 * errors[std::size_t(0.99 * double(errors.size() - 1))];
        cells.push_back(cell);
      }
  }

  gpu::Context& context_;
  StudyOptions options_;
  std::mt19937_64 random_;
  std::vector<PreparedView> views_;
  std::vector<GridCamera> cameras_;
  std::vector<LinearImage> images_;
  std::vector<Squares> squares_;  ///< of all footprints, ratios running faster
  std::unique_ptr<SampleImages> loaded_;
  gpu::Buffer view_buffer_;
};

}  // namespace

void describe(Described& to, StudyOptions& o) {
  to.number("squares", &o.squares, from_to(16, 100000), "",
            "squares a footprint in each of two images");
  to.number("repeats", &o.repeats, from_to(1, 1000), "",
            "times that the sweeps' timings are taken, and the samplers' up to twice; the quickest "
            "counts, and with 1 short ones are not taken anew on more squares either");
}

void StudyOptions::validate() const {
  check_options(*this);
  for (const int n : supersamples) PHOTOHULL_CHECK(n >= 1 && n <= kMaxSupersample);
  // Long footprints must stay on the image.
  for (const double f : footprints)
    for (const double r : ratios) PHOTOHULL_CHECK(f > 0 && r >= 1 && f * std::sqrt(r) <= kBorder);
}

std::vector<StudyCell> study_samplers(gpu::Context& context, const StudyOptions& options,
                                      Progress& progress) {
  options.validate();
  return Study(context, options).run(progress);
}

}  // namespace photohull::projtex

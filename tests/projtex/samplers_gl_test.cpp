// Every sampler's kernel against its reference.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "gpu/buffer.h"
#include "projtex/sample_images.h"
#include "projtex/sampler_reference.h"
#include "shared/sampling.h"
#include "support/filtering.h"
#include "support/gl_context.h"
#include "support/ray_cast.h"

namespace photohull::projtex {
namespace {

using glm::dvec2;
using glm::dvec3;
using reference::Footprint;
using reference::LinearImage;
using reference::PlaneSquare;

// Of full scale, in square roots of linear light; half floats alone account for 2.5e-4.
/// Of samplers whose weights the device computes, more where it rounds them.
double sample_bound() { return 1e-3 + 6 * test::filtering_error(); }
// Squares of which less than this is on the object tell nothing; quotients lose digits there.
constexpr double kLeastCoverage = shaders::kLeastCoverage;

struct Outcome {
  double worst = 0;
  int compared = 0, disagreements = 0;
  int thin = 0;   ///< squares with too little of the object
  int empty = 0;  ///< those of them with nothing
};

class SamplersTest : public ::testing::TestWithParam<Sampler> {
 protected:
  static constexpr int kWidth = 150, kHeight = 117;

  void TearDown() override { context_.check_errors("samplers test"); }

  PreparedView random_view(bool masked) {
    PreparedView view;
    view.camera = test::random_camera(rng_, {{-10, -10, -10}, {10, 10, 10}}, kWidth, kHeight);
    view.image = test::to_half(test::random_image(rng_, kWidth, kHeight));
    if (!masked) return view;
    view.mask.width = kWidth;
    view.mask.height = kHeight;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const double d = 45 - std::hypot(x - 0.5 * kWidth, y - 0.5 * kHeight);
        view.mask.coverage.push_back(
            std::uint8_t(std::lround(255 * std::clamp(d + 0.5, 0.0, 1.0))));
      }
    return view;
  }

  void load(std::vector<PreparedView> views, Sampler sampler) {
    images_ = std::make_unique<SampleImages>(views, sampler);
    cameras_.clear();
    chains_.clear();
    for (const PreparedView& view : views) {
      cameras_.push_back(to_grid(view.camera, grid_));
      chains_.push_back(reference::covered_chain(
          reference::covered_image(view.image, view.mask, images_->size())));
    }
  }

  std::vector<glm::vec4> run(const std::vector<PlaneSquare>& squares,
                             const std::vector<int>& view_of, int supersample) {
    std::vector<shaders::GpuView> views;
    for (const GridCamera& camera : cameras_) views.push_back(to_gpu_view(camera, images_->size()));
    std::vector<shaders::PlaneSquare> list;
    for (std::size_t i = 0; i < squares.size(); ++i)
      list.push_back({glm::vec4(squares[i].centre, view_of[i]), glm::vec4(squares[i].u, 0),
                      glm::vec4(squares[i].v, 0)});
    const gpu::Buffer view_buffer = gpu::Buffer::of(views), square_buffer = gpu::Buffer::of(list);
    const gpu::Buffer samples(squares.size() * 16);
    const auto program =
        images_->program(context_, "projtex_sample_squares.comp.glsl", supersample);
    program->set("count", int(squares.size()));
    view_buffer.bind_storage(shaders::kViewsBinding);
    square_buffer.bind_storage(shaders::kSquaresBinding);
    samples.bind_storage(shaders::kSquareSamplesBinding);
    images_->bind(*program);
    program->dispatch(context_, "projtex_sample_squares",
                      gpu::group_count(squares.size(), shaders::kSquareGroup));
    return samples.download<glm::vec4>(squares.size());
  }

  /// Does a step of the sampler's (the nearest pixel, a number of taps, a level of a Gaussian) lie
  /// within single precision's reach of a footprint?
  static bool at_step(Sampler sampler, const Footprint& f) {
    const auto near_integer = [](double v, double bound) {
      return std::abs(v - std::round(v)) < bound;
    };
    if (sampler == Sampler::kCentroid || sampler == Sampler::kNearest)
      return near_integer(f.pixel.x + 0.5, 1e-3) || near_integer(f.pixel.y + 0.5, 1e-3);
    if (sampler == Sampler::kMipmap)
      return near_integer(std::log2(std::max({glm::length(f.du), glm::length(f.dv), 1.0})) + 0.5,
                          1e-3);
    const reference::FootprintAxes axes = reference::axes_of(f);
    if (sampler == Sampler::kAnisotropic)
      return near_integer(axes.longer / std::max(axes.shorter, 0.5) - 0.25, 1e-3);
    if (sampler == Sampler::kEwa)
      return near_integer(std::log2(std::max(axes.shorter, axes.longer / 16) / 2), 1e-3);
    return false;
  }

  static PlaneSquare part_of(const PlaneSquare& square, int supersample, int k) {
    const double n = supersample;
    const double a = (k % supersample + 0.5) / n - 0.5, b = (k / supersample + 0.5) / n - 0.5;
    return {square.centre + a * square.u + b * square.v, square.u / n, square.v / n};
  }

  bool uncertain(Sampler sampler, const GridCamera& camera, const PlaneSquare& square,
                 int supersample) const {
    for (int k = 0; k < supersample * supersample; ++k) {
      const PlaneSquare part = part_of(square, supersample, k);
      const dvec3 p = camera.projection * glm::dvec4(part.centre, 1);
      // Positions in a camera's own plane have no digits left.
      if (std::abs(p.z) < 0.11) return true;
      if (p.z > 0 && at_step(sampler, reference::footprint_of(camera, part))) return true;
    }
    return false;
  }

  Outcome compare(const std::vector<PlaneSquare>& squares, int supersample,
                  double bound = sample_bound()) {
    const Sampler sampler = GetParam();
    std::vector<int> view_of;
    for (std::size_t i = 0; i < squares.size(); ++i) view_of.push_back(int(i % cameras_.size()));
    const auto found = run(squares, view_of, supersample);
    Outcome out;
    int reported = 0;
    for (std::size_t i = 0; i < squares.size(); ++i) {
      const std::size_t v = std::size_t(view_of[i]);
      if (uncertain(sampler, cameras_[v], squares[i], supersample)) continue;
      const glm::dvec4 expected = reference::resolved(
          reference::sample_square(sampler, chains_[v], cameras_[v], squares[i], supersample));
      const glm::dvec4 difference = glm::abs(expected - glm::dvec4(found[i]));
      if (!(difference.a < bound)) ++out.disagreements;
      if (expected.a < kLeastCoverage) {
        ++out.thin;
        out.empty += expected.a == 0;
        continue;
      }
      ++out.compared;
      const double worst = std::max({difference.r, difference.g, difference.b, difference.a});
      if (!(worst < bound) && ++reported < 4) {
        const Footprint f = reference::footprint_of(cameras_[v], squares[i]);
        ADD_FAILURE() << "square " << i << ": off by " << worst << "; pixel " << f.pixel.x << ", "
                      << f.pixel.y << "; du " << f.du.x << ", " << f.du.y << "; dv " << f.dv.x
                      << ", " << f.dv.y << "; coverage " << expected.a << "; found " << found[i].r
                      << " " << found[i].a;
      }
      out.worst = std::max(out.worst, worst);
    }
    return out;
  }

  /// Squares of any orientation about the middle of the view; edges of 2^low to 2^high pixels, one
  /// up to 16 times the other.
  std::vector<PlaneSquare> random_squares(int count, double low, double high) {
    std::vector<PlaneSquare> squares;
    for (int i = 0; i < count; ++i) {
      const GridCamera& camera = cameras_[std::size_t(i) % cameras_.size()];
      const dvec3 centre = test::uniform_in(rng_, {{-12, -12, -12}, {12, 12, 12}});
      const double q = (camera.projection * glm::dvec4(centre, 1)).z;
      const double edge = std::exp2(test::uniform(rng_, low, high)) * q / camera.focal;
      const double ratio = std::exp2(test::uniform(rng_, -4, 4));
      const dvec3 u = test::random_direction(rng_);
      const dvec3 v = glm::normalize(glm::cross(u, test::random_direction(rng_)));
      squares.push_back({centre, u * edge * std::sqrt(ratio), v * edge / std::sqrt(ratio)});
    }
    return squares;
  }

  gpu::Context& context_ = test::gl_context();
  test::Rng rng_{29};
  GridSpec grid_{{0, 0, 0}, 1, {3, 3, 3}};
  std::unique_ptr<SampleImages> images_;
  std::vector<GridCamera> cameras_;
  std::vector<std::vector<LinearImage>> chains_;
};

TEST_P(SamplersTest, RandomSquaresOfAllSizes) {
  load({random_view(false), random_view(false), random_view(false)}, GetParam());
  for (const int supersample : {1, 2, 3}) {
    const Outcome found = compare(random_squares(400, -2, 5), supersample);
    EXPECT_LT(found.worst, sample_bound());
    EXPECT_EQ(found.disagreements, 0);
    EXPECT_GT(found.compared, 150);
    std::printf("%s, %d x %d: worst %.2e of %d\n", to_string(GetParam()), supersample, supersample,
                found.worst, found.compared);
  }
}

TEST_P(SamplersTest, MasksAndBordersWeightTheSamples) {
  load({random_view(true), random_view(true)}, GetParam());
  for (const int supersample : {1, 2}) {
    const Outcome found = compare(random_squares(400, -1, 5), supersample);
    EXPECT_LT(found.worst, sample_bound());
    EXPECT_EQ(found.disagreements, 0);
    EXPECT_GT(found.compared, 100);
    EXPECT_GT(found.thin, 10);
  }
}

TEST_P(SamplersTest, DegenerateFootprints) {
  load({random_view(false)}, GetParam());
  const GridCamera& camera = cameras_[0];
  std::vector<PlaneSquare> squares;
  for (int i = 0; i < 60; ++i) {
    const dvec3 centre = test::uniform_in(rng_, {{-6, -6, -6}, {6, 6, 6}});
    const dvec3 ray = glm::normalize(centre - camera.centre), edge = test::random_direction(rng_);
    squares.push_back({centre, {0, 0, 0}, {0, 0, 0}});     // a point
    squares.push_back({centre, edge, {0, 0, 0}});          // a line
    squares.push_back({centre, edge, edge * 0.5});         // a line, twice
    squares.push_back({centre, ray, edge});                // edge-on
    squares.push_back({centre, ray * 20.0, edge * 0.01});  // long and edge-on
    // Around the camera itself, in part behind it.
    squares.push_back({camera.centre + test::random_direction(rng_) * 3.0, edge * 4.0, ray * 3.0});
    squares.push_back({camera.centre - ray * 5.0, edge, edge});  // behind
  }
  for (const int supersample : {1, 3}) {
    const Outcome found = compare(squares, supersample, 2 * sample_bound());
    EXPECT_EQ(found.disagreements, 0);
    EXPECT_GT(found.compared, 100);
    EXPECT_GT(found.empty, 50);
  }
}

TEST_P(SamplersTest, BackgroundNeverBleedsIntoTheObject) {
  // Red inside the mask, green and bright outside and, beyond the border, whatever a device
  // repeats.
  PreparedView view = random_view(true);
  view.image.encoding = ColourImage::Encoding::kSrgb8;
  view.image.bytes.clear();
  for (const std::uint8_t coverage : view.mask.coverage)
    for (const int channel : {coverage ? 255 : 0, coverage ? 0 : 255, 0, 255})
      view.image.bytes.push_back(std::uint8_t(channel));
  load({view}, GetParam());
  const auto squares = random_squares(500, -1, 5);
  int shown = 0;
  for (const glm::vec4& sample : run(squares, std::vector<int>(squares.size(), 0), 2)) {
    if (sample.a < kLeastCoverage) continue;
    ++shown;
    EXPECT_NEAR(sample.r, 1, 2e-3);
    EXPECT_NEAR(sample.g, 0, 2e-2);
  }
  EXPECT_GT(shown, 100);
}

// The device's own anisotropic filter has no reference but the oracle: its taps are its own affair.
using HardwareTest = SamplersTest;

TEST_P(HardwareTest, IsNearerToTheOracleThanTrilinearAlongLongFootprints) {
  PreparedView view = random_view(false);
  double errors[2] = {};
  int count = 0;
  for (const Sampler sampler : {Sampler::kTrilinear, GetParam()}) {
    load({view}, sampler);
    rng_.seed(5);
    std::vector<PlaneSquare> squares;
    for (const PlaneSquare& square : random_squares(1500, 1, 3)) {
      const reference::FootprintAxes axes =
          reference::axes_of(reference::footprint_of(cameras_[0], square));
      if (axes.longer > 4 * axes.shorter) squares.push_back(square);
    }
    const auto found = run(squares, std::vector<int>(squares.size(), 0), 1);
    for (std::size_t i = 0; i < squares.size(); ++i) {
      const glm::dvec4 truth =
          reference::resolved(reference::oracle(chains_[0][0], cameras_[0], squares[i]));
      if (truth.a < 0.99 || found[i].a < 0.99) continue;
      ++count;
      errors[sampler == GetParam()] += std::pow(truth.r - found[i].r, 2);
    }
  }
  EXPECT_GT(count, 200);
  EXPECT_LT(errors[1], 0.9 * errors[0]);
  std::printf("hardware: %.4f of trilinear's squared error\n", errors[1] / errors[0]);
}

INSTANTIATE_TEST_SUITE_P(Device, HardwareTest, ::testing::Values(Sampler::kHardware));

std::string name_of(const ::testing::TestParamInfo<Sampler>& info) {
  std::string name = to_string(info.param);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, SamplersTest,
                         ::testing::Values(Sampler::kMipmap, Sampler::kNearest, Sampler::kBilinear,
                                           Sampler::kTrilinear, Sampler::kTrilinearDerivative,
                                           Sampler::kRipmap, Sampler::kSummedArea,
                                           Sampler::kAnisotropic, Sampler::kEwa),
                         name_of);

}  // namespace
}  // namespace photohull::projtex

// Gains and vignetting, from made-up points with known ones and from a small rendered scene.
#include "views/photometric.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/error.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "io/mesh/read_mesh.h"
#include "photo/noise.h"
#include "support/pictures.h"
#include "support/scratch_folder.h"
#include "synth/synthesize.h"
#include "views/photometric_check.h"
#include "views/photometric_samples.h"
#include "views/prepare_views.h"

namespace photohull {
namespace {

struct World {
  std::vector<glm::dvec3> gains;  ///< geometric mean 1
  double vignetting = 0;
  std::vector<PhotometricPoint> points;
  std::vector<int> lenses;
};

/// Points seen by six neighbours of `views` views on a ring, colours with a deviation of 1 %;
/// one sample in ten is a highlight.
World make_world(int views, double spread, double vignetting, int count = 1500) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  World w;
  w.vignetting = vignetting;
  w.lenses.assign(std::size_t(views), 0);
  glm::dvec3 mean(0);
  for (int i = 0; i < views; ++i) {
    w.gains.push_back({spread * normal(random), spread * normal(random), spread * normal(random)});
    mean += w.gains.back() / double(views);
  }
  for (glm::dvec3& g : w.gains) g = glm::exp(g - mean);
  for (int i = 0; i < count; ++i) {
    PhotometricPoint p{i % 60, {}};
    const glm::dvec3 albedo(0.1 + 0.4 * uniform(random), 0.1 + 0.4 * uniform(random), 0.2);
    const int first = int(uniform(random) * views);
    for (int k = 0; k < 6; ++k) {
      PhotometricSample s;
      s.view = (first + k) % views;
      s.radius2 = uniform(random);
      s.sigma = glm::dvec3(0.01);
      s.colour = albedo * w.gains[std::size_t(s.view)] * (1 - vignetting * s.radius2);
      for (int c = 0; c < 3; ++c) s.colour[c] *= std::exp(0.01 * normal(random));
      if (uniform(random) < 0.1) s.colour += 0.3;
      p.samples.push_back(s);
    }
    w.points.push_back(p);
  }
  return w;
}

PhotometricCalibration calibrate(const World& w, const PhotometricOptions& options = {}) {
  return calibrate_photometric(w.points, w.lenses, options, Progress());
}

TEST(Photometric, FindsGainsAndVignettingUnderHighlights) {
  const World w = make_world(12, 0.2, 0.3);
  const PhotometricCalibration c = calibrate(w);
  ASSERT_TRUE(c.solved);
  EXPECT_TRUE(c.significant);
  EXPECT_TRUE(c.pays);
  EXPECT_NEAR(c.vignetting[0], 0.3, 0.005);
  EXPECT_GT(c.vignetting_sigma[0], 0.0);
  glm::dvec3 mean(0);
  double squares = 0;
  for (std::size_t i = 0; i < 12; ++i)
    for (int k = 0; k < 3; ++k) {
      const double error = std::log(c.views[i].gain[k] / w.gains[i][k]);
      EXPECT_NEAR(error, 0, 0.008) << i;
      squares += std::pow(error / c.views[i].sigma[k], 2) / 36;
      mean[k] += std::log(c.views[i].gain[k]);
    }
  EXPECT_LT(glm::length(mean), 1e-4);  // the gauge
  // Deviations are honest within a factor.
  EXPECT_GT(std::sqrt(squares), 0.5);
  EXPECT_LT(std::sqrt(squares), 2.0);
  EXPECT_GT(c.disagreement_before, 0.05);
  EXPECT_LT(c.disagreement_after, 0.015);
}

TEST(Photometric, LeavesEqualPhotographsAlone) {
  const PhotometricCalibration c = calibrate(make_world(12, 0, 0));
  ASSERT_TRUE(c.solved);
  EXPECT_EQ(c.vignetting[0], 0);
  EXPECT_FALSE(c.significant);
  EXPECT_FALSE(c.pays);
  EXPECT_LT(c.rms_gain, 0.003);
}

TEST(Photometric, ViewsWithLittleEvidenceStayAtOne) {
  World w = make_world(12, 0.2, 0);
  int kept = 0;
  for (PhotometricPoint& p : w.points)  // view 3 is left with ten samples
    std::erase_if(p.samples,
                  [&](const PhotometricSample& s) { return s.view == 3 && ++kept > 10; });
  w.lenses.push_back(0);  // and a view without any
  const PhotometricCalibration c = calibrate(w);
  ASSERT_TRUE(c.solved);
  for (const std::size_t i : {std::size_t(3), std::size_t(12)}) {
    EXPECT_FALSE(c.views[i].solved);
    EXPECT_EQ(c.views[i].gain, glm::dvec3(1));
    EXPECT_EQ(c.views[i].sigma, glm::dvec3(0));
  }
  EXPECT_EQ(c.views[3].samples, 10);
  glm::dvec3 mean(0);
  for (const ViewGain& view : c.views) mean += glm::log(view.gain);
  EXPECT_LT(glm::length(mean), 1e-4);
}

TEST(Photometric, ViewsThatShareNoPointsAreNotCompared) {
  World w = make_world(12, 0.2, 0);
  for (PhotometricPoint& p : w.points) {  // views 0 to 7 and 8 to 11 see different points
    const bool low = p.samples[0].view < 8;
    std::erase_if(p.samples, [&](const PhotometricSample& s) { return (s.view < 8) != low; });
  }
  const PhotometricCalibration c = calibrate(w);
  ASSERT_TRUE(c.solved);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(c.views[i].solved, i < 8) << i;
}

TEST(Photometric, NothingToCompareIsNotSolved) {
  EXPECT_FALSE(calibrate({{}, 0, {}, {0, 0}}).solved);
  World w = make_world(6, 0.2, 0);
  for (PhotometricPoint& p : w.points) p.samples.resize(1);
  const PhotometricCalibration c = calibrate(w);
  EXPECT_FALSE(c.solved);
  EXPECT_FALSE(c.pays);
  for (const ViewGain& view : c.views) EXPECT_EQ(view.gain, glm::dvec3(1));
}

TEST(Photometric, RejectsOptionsOutOfRange) {
  PhotometricOptions o;
  o.held_out = 0.9;
  EXPECT_THROW(o.validate(), UsageError);
  o = {};
  o.least_samples = 1;
  EXPECT_THROW(o.validate(), UsageError);
}

PhotometricCheck check(const World& w, const PhotometricCheckOptions& options = {}) {
  return check_photometric(w.points, int(w.gains.size()), options);
}

TEST(PhotometricCheck, GainsBeyondTheirNoiseDiffer) {
  for (const double spread : {0.03, 0.3}) {
    const World w = make_world(12, spread, 0, 600);
    double squares = 0;
    for (const glm::dvec3& g : w.gains) squares += glm::dot(glm::log(g), glm::log(g)) / 36;
    const PhotometricCheck c = check(w);
    EXPECT_TRUE(c.differ) << spread;
    EXPECT_EQ(c.views, 12);
    EXPECT_EQ(c.samples, 3600);
    EXPECT_NEAR(c.rms_gain, std::sqrt(squares), 0.1 * spread);
    EXPECT_LT(c.noise, 0.1 * spread);
    EXPECT_GT(c.profit, 0.3);
  }
}

TEST(PhotometricCheck, EqualPhotographsDoNot) {
  const PhotometricCheck c = check(make_world(12, 0, 0, 600));
  EXPECT_FALSE(c.differ);
  EXPECT_LT(c.rms_gain, 3 * c.noise);
  EXPECT_LT(std::abs(c.vignetting), 0.02);
}

// They would be found, and make no difference beside what colours differ in anyway.
TEST(PhotometricCheck, GainsThatDoNotPayAreLeft) {
  const World w = make_world(12, 0.002, 0, 20000);
  const PhotometricCheck c = check(w);
  EXPECT_GT(c.rms_gain, 3 * c.noise);
  EXPECT_FALSE(c.differ);
  PhotometricCheckOptions all;
  all.least_profit = 0;
  EXPECT_TRUE(check(w, all).differ);
}

TEST(PhotometricCheck, NoiseOfTheEstimateIsMeasured) {
  const double noise = check(make_world(12, 0, 0, 600)).noise;
  World w = make_world(12, 0, 0, 600);
  for (PhotometricPoint& p : w.points)  // what a cluster has in common in a view is no gain
    for (PhotometricSample& s : p.samples)
      s.colour *= std::exp(0.1 * std::sin(37.0 * p.cluster + 11.0 * s.view));
  const PhotometricCheck c = check(w);
  EXPECT_GT(c.noise, 2 * noise);
  EXPECT_FALSE(c.differ);
}

TEST(PhotometricCheck, VignettingCounts) {
  const PhotometricCheck c = check(make_world(12, 0, 0.3, 600));
  EXPECT_TRUE(c.differ);
  EXPECT_NEAR(c.vignetting, 0.3, 0.06);
}

TEST(PhotometricCheck, TooFewSamplesSayNothing) {
  const PhotometricCheck c = check(make_world(12, 0.3, 0, 20));
  EXPECT_FALSE(c.differ);
  EXPECT_LT(c.views, 2);
}

TEST(PhotometricCheck, RejectsOptionsOutOfRange) {
  PhotometricCheckOptions o;
  o.least_samples = 2;
  EXPECT_THROW(o.validate(), UsageError);
  o = {};
  o.least_profit = 1;
  EXPECT_THROW(o.validate(), UsageError);
}

TEST(Photometric, FramesTellTheRadiusOfCroppedPictures) {
  PhotometricFrame frame{{200, 100, 150, 150, 0, 90, 40}, {}};
  Intrinsics cropped = frame.intrinsics;
  cropped.cx -= 30, cropped.cy -= 10, cropped.width = 80, cropped.height = 50;
  EXPECT_NEAR(frame.radius2(cropped, {99.5 - 30, 49.5 - 10}), 0, 1e-12);
  EXPECT_NEAR(frame.radius2(cropped, {-30, -10}), 1, 1e-12);
  frame.distortion = {DistortionModel::kBrown, {-0.1}};
  // The lens draws the corner in: the ideal picture has it farther out.
  EXPECT_LT(frame.radius2(frame.intrinsics, {0, 0}), 1);
}

TEST(Photometric, LensesAreSharedBySizeAndFocalLength) {
  const PhotometricFrame a{{200, 100, 150, 150}, {}}, b{{200, 100, 151, 151}, {}},
      c{{200, 100, 200, 200}, {}}, d{{100, 200, 150, 150}, {}};
  const std::vector<PhotometricFrame> frames = {a, c, b, d};
  EXPECT_EQ(shared_lenses(frames), (std::vector<int>{0, 1, 0, 2}));
}

TEST(Photometric, CorrectionUndoesGainAndVignetting) {
  const Paint grey = [](double x, double) { return glm::vec3(float(0.1 + 0.004 * x), 0.2f, 0.3f); };
  const glm::vec3 gain(1.3f, 1.0f, 0.8f);
  const auto radius2 = [](double x, double y) {
    return float((std::pow(x - 49.5, 2) + std::pow(y - 39.5, 2)) / (49.5 * 49.5 + 39.5 * 39.5));
  };
  const Paint taken = [&](double x, double y) {
    return grey(x, y) * gain * (1 - 0.4f * radius2(x, y));
  };
  std::vector<PreparedView> views(2);
  views[0].image = paint_srgb(100, 80, taken);
  views[1].image = paint_half(100, 80, taken);
  for (PreparedView& view : views) view.camera.intrinsics = {100, 80, 120, 120, 0, 50, 40};
  PhotometricCalibration c;
  c.views.assign(2, {gain, glm::dvec3(0.01), 100, true});
  c.vignetting = {0.4};
  const std::vector<PhotometricFrame> frames(2, {{100, 80, 120, 120, 0, 50, 40}, {}});
  apply_photometric(c, frames, {0, 0}, views);
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 100; ++x)
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(views[0].image.linear(x, y)[k], grey(x, y)[k], 0.006);
        EXPECT_NEAR(views[1].image.linear(x, y)[k], grey(x, y)[k], 0.001);
      }
  EXPECT_EQ(views[0].image.linear(5, 5).a, 1);
}

/// A rendered scene of 12 small views with known gains.
TEST(Photometric, RecoversTheGainsOfARenderedScene) {
  const ScratchFolder folder;
  synth::Spec spec;
  spec.geometry.shape = "sphere";
  spec.image = {160, 120, 2};
  spec.cameras.rings = {{6, 10, 0}, {6, 40, 0.5}};
  spec.truth_samples = 100;
  spec.degradations.exposure = 0.2;
  spec.degradations.white_balance = 0.2;
  spec.degradations.vignetting = 0.3;
  spec.degradations.photon_noise = 0.01;
  spec.material.octaves = 2;
  Progress silent;
  const auto made = synth::synthesize(spec, folder / "scene", silent);
  Scene scene = io::load_scene(folder / "scene");
  const ViewLoader loader{[](const auto& path) { return io::read_image(path); },
                          [](const auto& path) { return io::read_mask(path); }};
  const PreparedViews prepared = prepare_views(scene, loader, {}, silent);
  TriMesh mesh = read_mesh(folder / "scene" / "gt.ply");
  mesh.normals.clear();
  for (const glm::vec3& p : mesh.positions)
    mesh.normals.push_back(glm::normalize(p + glm::vec3(mesh.origin)));
  const auto frames = frames_of(prepared.views);
  const auto lenses = shared_lenses(frames);
  const auto points = sample_photometric(mesh, 0.02, prepared.views, frames,
                                         estimate_image_noise(prepared.views[0].image), silent);
  const PhotometricCalibration c = calibrate_photometric(points, lenses, {}, silent);
  ASSERT_TRUE(c.solved);
  EXPECT_TRUE(c.pays);
  ASSERT_EQ(made.gains.size(), 12u);
  glm::dvec3 mean(0);
  for (const glm::dvec3& gain : made.gains) mean += glm::log(gain) / 12.0;
  for (std::size_t i = 0; i < 12; ++i) {
    const glm::dvec3 truth = glm::exp(glm::log(made.gains[i]) - mean);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(c.views[i].gain[k] / truth[k], 1, 0.02) << i;
  }
  EXPECT_NEAR(c.vignetting[0], 0.3, 0.08);
}

}  // namespace
}  // namespace photohull

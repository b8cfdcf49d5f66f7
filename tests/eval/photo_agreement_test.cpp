#include "eval/photo_agreement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "eval/agreement_json.h"
#include "eval/agreement_picture.h"
#include "photo_scenes.h"
#include "shapes.h"

namespace photohull::eval {
namespace {

using test::plane_views;
using test::sphere;
using test::sphere_views;
using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<std::size_t> kHeldOut = {2, 5};
const std::vector<std::size_t> kLenders = {0, 1, 3, 4, 6, 7};

const std::vector<PreparedView>& ring() {
  static const std::vector<PreparedView> views = sphere_views(8);
  return views;
}

PhotoScore judge(const TriMesh& mesh) {
  return judge_by_photographs(mesh, ring(), kHeldOut, kLenders).all;
}

TEST(PhotoAgreement, TheTrueSphereAgrees) {
  const PhotoScore s = judge(sphere({0, 0, 0}, 1, 6));
  EXPECT_TRUE(s.masked);
  EXPECT_GT(s.zncc(), 0.94);  // a rim of two pixels mixes with the background
  EXPECT_GT(s.psnr(), 30);
  EXPECT_LT(s.mean_difference(), 0.02);
  EXPECT_GT(s.silhouette_iou(), 0.98);
  EXPECT_LT(s.excess(), 0.01);
  EXPECT_GT(s.judged, 0.9 * double(s.foreground));
}

TEST(PhotoAgreement, WrongSpheresAgreeLess) {
  const double right = *judge(sphere({0, 0, 0}, 1, 6)).zncc();
  const PhotoScore small = judge(sphere({0, 0, 0}, 0.95, 6));
  const PhotoScore large = judge(sphere({0, 0, 0}, 1.1, 6));
  const PhotoScore moved = judge(sphere({0, 0, 0.1}, 1, 6));
  EXPECT_LT(small.zncc(), right - 0.05);
  EXPECT_LT(large.zncc(), right - 0.1);
  EXPECT_LT(moved.zncc(), right - 0.05);
  EXPECT_NEAR(*small.silhouette_iou(), 0.95 * 0.95, 0.01);
  EXPECT_NEAR(*small.coverage(), 0.95 * 0.95, 0.01);
  EXPECT_NEAR(*large.excess(), 1 - 1 / (1.1 * 1.1), 0.015);
  EXPECT_NEAR(*large.coverage(), 1, 1e-9);
  EXPECT_LT(large.psnr(), judge(sphere({0, 0, 0}, 1, 6)).psnr());
}

// Half of the sphere predicts its half as well as the whole does, and must not gain by that.
TEST(PhotoAgreement, UncoveredPixelsCount) {
  TriMesh half = sphere({0, 0, 0}, 1, 6);
  std::erase_if(half.triangles, [&](const std::array<std::uint32_t, 3>& t) {
    return half.positions[t[0]].z < -0.2f;  // what is behind cannot be seen through there
  });
  const PhotoScore s = judge(half), whole = judge(sphere({0, 0, 0}, 1, 6));
  EXPECT_LT(s.zncc(), *whole.zncc() - 0.15);
  EXPECT_GT(s.zncc_predicted(), 0.8);
  EXPECT_EQ(s.judged, whole.judged);
  EXPECT_LT(s.judged_predicted, whole.judged_predicted);
  EXPECT_NEAR(*s.zncc(), *s.zncc_predicted() * double(s.judged_predicted) / double(s.judged), 1e-9);
}

// Lenders farther away show an error of depth that near ones hide.
TEST(PhotoAgreement, GreaterAnglesAreStricter) {
  const TriMesh wrong = sphere({0, 0, 0}, 0.9, 6);
  PhotoOptions far;
  far.predict.least_angle = 20;
  const auto score = [&](const PhotoOptions& o) {
    return *judge_by_photographs(wrong, ring(), kHeldOut, kLenders, o).all.zncc_predicted();
  };
  EXPECT_LT(score(far), score({}) - 0.2);
}

TEST(PhotoAgreement, PlainPhotographsTellNothing) {
  test::Rng random(3);
  std::vector<PreparedView> views = plane_views(
      5, [](const glm::dvec3&, const glm::dvec3&) { return glm::dvec3(0.3, 0.25, 0.2); });
  for (PreparedView& view : views)
    for (std::size_t i = 0; i < view.image.bytes.size(); ++i)
      if (i % 4 != 3)
        view.image.bytes[i] = std::uint8_t(view.image.bytes[i] + int(test::uniform(random, -3, 4)));
  PhotoMaps worst;
  const PhotoAgreement a = judge_by_photographs(test::plate(-5, -5, 0, 10, 1), views, {{2}},
                                                {{1, 3}}, {}, nullptr, &worst);
  EXPECT_EQ(a.all.judged, 0);
  EXPECT_FALSE(a.all.zncc());
  EXPECT_FALSE(a.worst);
  EXPECT_GT(a.all.psnr(), 30);
  EXPECT_THAT(a.warnings, ElementsAre(HasSubstr("no mask"), HasSubstr("no window")));
}

TEST(PhotoAgreement, WithoutMasksAllOfThePhotographCounts) {
  const std::vector<PreparedView> views = plane_views(5);
  const PhotoScore all =
      judge_by_photographs(test::plate(-5, -5, 0, 10, 1), views, {{2}}, {{1, 3}}).all;
  const PhotoScore half =
      judge_by_photographs(test::plate(0, -5, 0, 10, 1), views, {{2}}, {{1, 3}}).all;
  EXPECT_FALSE(all.masked);
  EXPECT_EQ(all.foreground, 96 * 80);
  EXPECT_FALSE(all.excess());
  EXPECT_FALSE(all.silhouette_iou());
  EXPECT_GT(all.zncc(), 0.9);
  EXPECT_NEAR(*half.zncc(), 0.5 * *all.zncc(), 0.03);
  EXPECT_NEAR(*half.coverage(), 0.5, 0.01);
}

TEST(PhotoAgreement, UnknownPixelsCountNowhere) {
  std::vector<PreparedView> views = plane_views(5);
  views[2].image.has_alpha = true;
  for (int i = 0; i < 96 * 40; ++i) views[2].image.bytes[4 * std::size_t(i) + 3] = 0;
  const PhotoScore s =
      judge_by_photographs(test::plate(-5, -5, 0, 10, 1), views, {{2}}, {{1, 3}}).all;
  EXPECT_EQ(s.pixels, 96 * 40);
  EXPECT_EQ(s.foreground, 96 * 40);
  EXPECT_EQ(s.projected, 96 * 40);
}

TEST(PhotoAgreement, BadInputIsNamed) {
  const TriMesh mesh = sphere({0, 0, 0}, 1, 3);
  const auto error = [&](const TriMesh& m, const std::vector<std::size_t>& held_out,
                         const std::vector<std::size_t>& lenders, const PhotoOptions& o = {}) {
    try {
      judge_by_photographs(m, ring(), held_out, lenders, o);
    } catch (const Error& failure) {
      return std::string(failure.what());
    }
    return std::string("none");
  };
  EXPECT_THAT(error({}, {2}, {1}), HasSubstr("no triangles"));
  EXPECT_THAT(error(test::moved(mesh, {100, 0, 0}), {2}, {1}), HasSubstr("no held-out view sees"));
  EXPECT_THAT(error(mesh, {}, {1}), HasSubstr("no photograph is held out"));
  EXPECT_THAT(error(mesh, {1}, {}), HasSubstr("none is left"));
  EXPECT_THAT(error(mesh, {1}, {0, 1}), HasSubstr("view 1 is held out and lends"));
  PhotoOptions even;
  even.window = 8;
  EXPECT_THAT(error(mesh, {2}, {1}, even), HasSubstr("an odd number of pixels from 3 to 63"));
}

TEST(PhotoAgreement, IsTheSameWithOneThreadAndCanBeCancelled) {
  const TriMesh mesh = sphere({0, 0, 0}, 0.98, 5);
  const std::string many = to_json(judge_by_photographs(mesh, ring(), kHeldOut, kLenders));
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(to_json(judge_by_photographs(mesh, ring(), kHeldOut, kLenders)), many);
  }
  process_cancellation().cancel();
  EXPECT_THROW(judge_by_photographs(mesh, ring(), kHeldOut, kLenders), Cancelled);
  process_cancellation().reset();
}

TEST(PhotoAgreement, JsonHoldsTheFiguresWithinAnother) {
  const PhotoAgreement a =
      judge_by_photographs(sphere({0, 0, 0}, 1, 4), ring(), kHeldOut, kLenders);
  const auto j = nlohmann::json::parse(to_json(a, R"({"recon": "x", "f": [1]})"));
  EXPECT_EQ(j["recon"], "x");
  EXPECT_EQ(j["photos"]["all"]["zncc"], *a.all.zncc());
  EXPECT_EQ(j["photos"]["views"].size(), 2u);
  EXPECT_EQ(j["photos"]["views"][1]["view"], "ring5");
  EXPECT_EQ(j["photos"]["views"][1]["pixels"]["judged"], a.views[1].judged);
  EXPECT_EQ(j["photos"]["worst"], a.views[*a.worst].view);
  EXPECT_EQ(j["photos"]["lenders"], 6);
}

// A sphere that is too small and off to one side leaves foreground bare and covers background.
TEST(PhotoAgreement, PictureShowsTheWorstView) {
  PhotoMaps worst;
  const PhotoAgreement a = judge_by_photographs(sphere({0.3, 0, 0}, 0.9, 5), ring(), kHeldOut,
                                                kLenders, {}, nullptr, &worst);
  const std::size_t other = 1 - *a.worst;
  EXPECT_LE(a.views[*a.worst].zncc(), a.views[other].zncc());
  ASSERT_EQ(worst.view, kHeldOut[*a.worst]);
  const RgbImage image = draw_agreement(ring()[worst.view], worst, "title");
  ASSERT_EQ(image.rgb.size(), std::size_t(image.width) * std::size_t(image.height) * 3);
  int uncovered = 0, excess = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    uncovered += image.rgb[i] == 40 && image.rgb[i + 1] == 150 && image.rgb[i + 2] == 70;
    excess += image.rgb[i] == 225 && image.rgb[i + 1] == 190 && image.rgb[i + 2] == 40;
  }
  const PhotoScore& s = a.views[*a.worst];
  const double pixels = double(uncovered) / double(s.foreground - s.covered);
  EXPECT_GT(uncovered, 0);
  EXPECT_GT(excess, 0);
  EXPECT_NEAR(double(excess) / double(s.projected - s.covered), pixels, 1e-9);
}

}  // namespace
}  // namespace photohull::eval

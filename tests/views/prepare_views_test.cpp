// prepare_views with pictures from memory.
#include "views/prepare_views.h"

#include <gmock/gmock.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <set>

#include "views/prepare_views_fixture.h"

namespace photohull {
namespace {

using testing::HasSubstr;

TEST_F(PrepareViews, KeepsOrderNamesCamerasAndBytes) {
  for (int i = 0; i < 20; ++i) {
    const auto image =
        paint_srgb(kWidth, kHeight, [i](double, double) { return glm::vec3(float(i) / 20.0f); });
    add_view(concat("v", i), image);
    add_mask(kDisc);
    scene_.views.back().camera.cam_from_world.translation.x = i;
  }
  const PreparedViews prepared = prepare();
  ASSERT_EQ(prepared.views.size(), 20u);
  for (int i = 0; i < 20; ++i) {
    const PreparedView& view = prepared.views[std::size_t(i)];
    EXPECT_EQ(view.name, concat("v", i));
    EXPECT_EQ(view.camera.cam_from_world.translation.x, i);
    EXPECT_EQ(view.image.bytes, images_["images/" + view.name].bytes);
    EXPECT_FALSE(view.image.has_alpha);
  }
  EXPECT_EQ(loads_, 20);
}

TEST_F(PrepareViews, NamesFilesOfWrongSize) {
  add_view("a.png", clay_disc());
  scene_.views[0].camera.intrinsics.width = 65;
  EXPECT_THAT(error_of_prepare(),
              testing::AllOf(HasSubstr("images/a.png"), HasSubstr("64x48"), HasSubstr("65x48")));
  scene_.views[0].camera.intrinsics.width = kWidth;
  add_mask(paint_mask(32, 30, disc));
  EXPECT_THAT(error_of_prepare(),
              testing::AllOf(HasSubstr("masks/a.png"), HasSubstr("32x30"), HasSubstr("64x48")));
}

/// Decodes all but those of the given names.
class TornPictures : public PrepareViews {
 protected:
  TornPictures() {
    for (int i = 0; i < 6; ++i) {
      add_view(concat(i, ".png"), clay_disc());
      scene_.views.back().camera.cam_from_world.translation.x = i;
    }
    scene_.tracks = {{{{0, {}}, {1, {}}, {5, {}}}}};
    loader_.image = [this](const std::filesystem::path& p) {
      if (torn_.contains(p.stem().string())) throw Error(p.string() + ": cut short");
      return images_.at(p.string());
    };
    loader_.mask = [this](const std::filesystem::path& p) { return masks_.at(p.string()); };
  }

  std::set<std::string> torn_;
  ViewLoader loader_;
};

TEST_F(TornPictures, AreLeftOutOfTheSceneToo) {
  torn_ = {"1", "4"};
  const PreparedViews prepared = prepare_views(scene_, loader_, {}, progress_);
  ASSERT_EQ(prepared.views.size(), 4u);
  ASSERT_EQ(scene_.views.size(), 4u);
  ASSERT_EQ(prepared.masks.size(), 4u);
  const double left[] = {0, 2, 3, 5};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(scene_.views[i].camera.cam_from_world.translation.x, left[i]);
    EXPECT_EQ(prepared.views[i].camera.cam_from_world.translation.x, left[i]);
    EXPECT_FALSE(prepared.views[i].mask.empty());
  }
  EXPECT_EQ(scene_.tracks.at(0).observations.at(1).view, 3);
  EXPECT_THAT(prepared.warnings.at(0),
              HasSubstr("2 of 6 photographs cannot be read and are left out (1.png: cut short, "
                        "4.png: cut short)"));
  EXPECT_EQ(scene_.left_out.size(), 2u);
}

TEST_F(TornPictures, AreAnErrorWhereTooFewRemainOrAllAreAskedFor) {
  Scene before = scene_;
  torn_ = {"1"};
  EXPECT_THROW(prepare_views(scene_, loader_, {.strict = true}, progress_), Error);
  scene_ = before;
  torn_ = {"1", "2", "3"};
  EXPECT_THROW(prepare_views(scene_, loader_, {}, progress_), Error);
  scene_ = before;
  scene_.usable_share = 0.8;  // others were left out before
  torn_ = {"1", "2"};
  EXPECT_THROW(prepare_views(scene_, loader_, {}, progress_), Error);
}

TEST_F(TornPictures, LackOfMemoryIsNoFaultOfThePicture) {
  loader_.image = [this](const std::filesystem::path& p) {
    if (p.stem() == "3") throw MemoryError("no memory");
    return images_.at(p.string());
  };
  EXPECT_THROW(prepare_views(scene_, loader_, {}, progress_), MemoryError);
}

TEST_F(PrepareViews, RejectsEmptyScenesAndBadOptions) {
  scene_.path = "scene.txt";
  EXPECT_THAT(error_of_prepare(), HasSubstr("scene.txt"));
  add_view("a.png", clay_disc());
  EXPECT_THROW(prepare({.max_frame_growth = 0.5}), UsageError);
  EXPECT_THROW(prepare({.max_frame_growth = std::nan("")}), UsageError);
}

TEST_F(PrepareViews, StopsWhenCancelled) {
  add_view("a.png", clay_disc());
  process_cancellation().cancel();
  EXPECT_THROW(prepare(), Cancelled);
  process_cancellation().reset();
  EXPECT_EQ(loads_, 0);
}

TEST_F(PrepareViews, RemovesDistortionFromImageMaskAndCamera) {
  add_view("a.png", clay_disc());
  add_mask(kDisc);
  scene_.views[0].distortion = {DistortionModel::kBrown, {-0.2}};
  const PreparedView view = prepare().views[0];
  EXPECT_EQ(view.image.width, view.camera.intrinsics.width);
  EXPECT_EQ(view.mask.width, view.image.width);
  EXPECT_EQ(view.mask.height, view.image.height);
  EXPECT_GT(view.image.width, kWidth);
  EXPECT_TRUE(view.image.has_alpha);
  const Intrinsics& k = view.camera.intrinsics;
  EXPECT_EQ(k.fx, 60);
  // The disc's light and its mask stay together.
  for (int y = 0; y < k.height; ++y)
    for (int x = 0; x < k.width; ++x) {
      if (view.image.linear(x, y).a == 0) continue;
      const int coverage = view.mask.coverage[std::size_t(y) * k.width + std::size_t(x)];
      if (coverage == 255) {
        ASSERT_GT(view.image.linear(x, y).r, 0.35) << x << "," << y;
      } else if (coverage == 0) {
        ASSERT_LT(view.image.linear(x, y).r, 0.15) << x << "," << y;
      }
    }
}

TEST_F(PrepareViews, WorksWithinTheCallersArena) {
  for (int i = 0; i < 8; ++i) {
    add_view(std::to_string(i), clay_disc());
    add_mask(kDisc);
  }
  std::atomic<int> running{0}, most{0};
  ViewLoader loader;
  loader.image = [&](const std::filesystem::path& p) {
    most = std::max(most.load(), ++running);
    ColourImage image = images_.at(p.string());
    --running;
    return image;
  };
  loader.mask = [this](const std::filesystem::path& p) { return masks_.at(p.string()); };
  tbb::task_arena(1).execute([&] { prepare_views(scene_, loader, {}, progress_); });
  EXPECT_EQ(most, 1);
}

TEST_F(PrepareViews, ReportsRisingProgress) {
  struct Recorder : Progress {
    void update(double fraction) override { fractions.push_back(fraction); }
    std::vector<double> fractions;
  } recorder;
  for (int i = 0; i < 5; ++i) add_view(std::to_string(i), clay_disc());
  const ViewLoader loader{[](const std::filesystem::path&) { return clay_disc(); }, {}};
  prepare_views(scene_, loader, {}, recorder);
  ASSERT_FALSE(recorder.fractions.empty());
  EXPECT_TRUE(std::is_sorted(recorder.fractions.begin(), recorder.fractions.end()));
  EXPECT_NEAR(recorder.fractions.back(), 1, 1e-12);
}

}  // namespace
}  // namespace photohull

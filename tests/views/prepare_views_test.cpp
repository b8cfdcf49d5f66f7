// prepare_views with pictures from memory.
#include "views/prepare_views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <map>
#include <set>

#include "core/error.h"
#include "masks/silhouette.h"
#include "support/pictures.h"

namespace photohull {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kWidth = 64, kHeight = 48;

double disc(double x, double y) { return std::clamp(14.5 - std::hypot(x - 30, y - 24), 0.0, 1.0); }

ColourImage clay_disc() {
  return paint_srgb(kWidth, kHeight, [](double x, double y) {
    return float(disc(x, y)) * glm::vec3(0.5f, 0.4f + 0.002f * float(x), 0.3f);
  });
}

ColourImage with_alpha(ColourImage image, const Mask& alpha) {
  image.has_alpha = true;
  for (std::size_t i = 0; i < alpha.coverage.size(); ++i) {
    if (image.encoding == ColourImage::Encoding::kSrgb8) {
      image.bytes[i * 4 + 3] = alpha.coverage[i];
    } else {
      const std::uint16_t half = glm::packHalf1x16(float(alpha.coverage[i]) / 255.0f);
      std::memcpy(&image.bytes[i * 8 + 6], &half, 2);
    }
  }
  return image;
}

/// A scene whose files live in memory.
class PrepareViews : public testing::Test {
 protected:
  void add_view(const std::string& name, const ColourImage& image) {
    SourceView view;
    view.name = name;
    view.image = "images/" + name;
    view.camera.intrinsics = {image.width, image.height, 60, 60, 0, 31.5, 23.5};
    scene_.views.push_back(view);
    images_["images/" + name] = image;
  }

  void add_mask(const Mask& mask) {
    SourceView& view = scene_.views.back();
    view.mask = "masks/" + view.name;
    masks_[view.mask.string()] = mask;
  }

  PreparedViews prepare(const PrepareOptions& options = {}) {
    ViewLoader loader;
    loader.image = [this](const std::filesystem::path& p) {
      ++loads_;
      return images_.at(p.string());
    };
    loader.mask = [this](const std::filesystem::path& p) { return masks_.at(p.string()); };
    return prepare_views(scene_, loader, options, progress_);
  }

  std::string error_of_prepare() {
    try {
      prepare();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  Scene scene_;
  std::map<std::string, ColourImage> images_;
  std::map<std::string, Mask> masks_;
  std::atomic<int> loads_{0};
  Progress progress_;
};

const Mask kDisc = paint_mask(kWidth, kHeight, disc);
const Mask kEmpty = paint_mask(kWidth, kHeight, [](double, double) { return 0.0; });
const Mask kFull = paint_mask(kWidth, kHeight, [](double, double) { return 1.0; });
const Mask kInverted =
    paint_mask(kWidth, kHeight, [](double x, double y) { return 1 - disc(x, y); });

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
    const View& view = prepared.views[std::size_t(i)];
    EXPECT_EQ(view.name, concat("v", i));
    EXPECT_EQ(view.camera.cam_from_world.translation.x, i);
    EXPECT_EQ(view.image.bytes, images_["images/" + view.name].bytes);
    EXPECT_FALSE(view.image.has_alpha);
  }
  EXPECT_EQ(loads_, 20);
}

TEST_F(PrepareViews, TakesMaskFilesAsTheyAre) {
  add_view("a.png", with_alpha(clay_disc(), kInverted));
  add_mask(kDisc);
  const PreparedViews prepared = prepare();
  EXPECT_EQ(prepared.views[0].mask.coverage, kDisc.coverage);  // the file, not the alpha channel
  EXPECT_EQ(prepared.mask_source, "mask files");
  EXPECT_EQ(prepared.mask_confidence, 1);
  EXPECT_THAT(prepared.warnings, IsEmpty());
}

TEST_F(PrepareViews, TakesAlphaThatVaries) {
  add_view("a.png", with_alpha(clay_disc(), kDisc));
  const auto half = paint_half(kWidth, kHeight, [](double, double) { return glm::vec3(2.0f); });
  add_view("b.exr", with_alpha(half, kDisc));
  const PreparedViews prepared = prepare();
  EXPECT_EQ(prepared.mask_source, "alpha channels");
  for (const View& view : prepared.views) {
    for (std::size_t i = 0; i < kDisc.coverage.size(); ++i)
      ASSERT_NEAR(view.mask.coverage[i], kDisc.coverage[i], 1);
    EXPECT_EQ(view.image.linear(0, 0).a, 1);  // alpha now says what is known: all
    EXPECT_FALSE(view.image.has_alpha);
  }
}

TEST_F(PrepareViews, FallsBackToTheBackground) {
  add_view("a.png", with_alpha(clay_disc(), kFull));  // a constant alpha channel says nothing
  add_view("b.png", clay_disc());
  const PreparedViews prepared = prepare();
  EXPECT_EQ(prepared.mask_source, "background model");
  EXPECT_GT(prepared.mask_confidence, 0.7);
  for (const View& view : prepared.views) {
    ASSERT_FALSE(view.mask.empty());
    EXPECT_LT(silhouette_distance(view.mask).pixels[24 * kWidth + 30], -13);
    EXPECT_GT(silhouette_distance(view.mask).pixels[0], 20);
  }
}

TEST_F(PrepareViews, CutsNoSilhouetteWhereTheSceneSaysSo) {
  for (const char* name : {"a.png", "b.png", "c.png"}) add_view(name, clay_disc());
  scene_.views[1].silhouette = false;
  const PreparedViews prepared = prepare();
  EXPECT_FALSE(prepared.views[0].mask.empty());
  EXPECT_TRUE(prepared.views[1].mask.empty());
  EXPECT_FALSE(prepared.views[2].mask.empty());
}

TEST_F(PrepareViews, SaysWhichViewsGotWhichMasks) {
  add_view("a.png", clay_disc());
  add_mask(kDisc);
  add_view("b.png", with_alpha(clay_disc(), kDisc));
  add_view("c.png", clay_disc());
  add_view("d.png", clay_disc());
  EXPECT_EQ(prepare().mask_source,
            "mask files (1 views), alpha channels (1 views), background model (2 views)");
}

TEST_F(PrepareViews, GivesNoMasksWithoutHope) {
  for (const char* name : {"a.png", "b.png"})
    add_view(name, paint_srgb(kWidth, kHeight, [](double, double) { return glm::vec3(0.4f); }));
  const PreparedViews prepared = prepare();
  EXPECT_TRUE(prepared.views[0].mask.empty());
  EXPECT_EQ(prepared.mask_source, "none");
  EXPECT_EQ(prepared.mask_confidence, 0);
  EXPECT_THAT(prepared.warnings, testing::ElementsAre(HasSubstr("2 views have no mask")));
}

TEST_F(PrepareViews, DropsMasksThatFillMostViews) {
  // The frame's colours do not occur inside: a model that calls everything else the object.
  for (const char* name : {"a.png", "b.png"})
    add_view(name, paint_srgb(kWidth, kHeight, [](double x, double y) {
               return glm::vec3(float(0.5 + 0.4 * std::sin(x)), float(0.5 + 0.4 * std::cos(y)),
                                0.5f);
             }));
  const PreparedViews prepared = prepare();
  EXPECT_TRUE(prepared.views[0].mask.empty());
  EXPECT_EQ(prepared.mask_source, "none");
  EXPECT_THAT(prepared.warnings, testing::ElementsAre(HasSubstr("in 0 of 2 views only")));
}

TEST_F(PrepareViews, FoundMasksAreNeverEmpty) {
  for (const char* name : {"a.png", "b.png", "c.png"}) add_view(name, clay_disc());
  add_view("black.png", paint_srgb(kWidth, kHeight, [](double, double) { return glm::vec3(0); }));
  const PreparedViews prepared = prepare();
  EXPECT_FALSE(prepared.views[0].mask.empty());
  EXPECT_TRUE(prepared.views[3].mask.empty());
  ASSERT_EQ(prepared.warnings.size(), 1u);
  EXPECT_THAT(prepared.warnings[0], HasSubstr("black.png"));
}

TEST_F(PrepareViews, PolicyNoneIgnoresAllMasks) {
  add_view("a.png", with_alpha(clay_disc(), kDisc));
  add_mask(kInverted);
  const PreparedViews prepared = prepare({.masks = MaskPolicy::kNone});
  EXPECT_TRUE(prepared.views[0].mask.empty());
  EXPECT_EQ(prepared.mask_source, "none");
  EXPECT_EQ(prepared.views[0].image.linear(0, 0).a, 1);
}

TEST_F(PrepareViews, WarnsOfEmptyAndFullMasks) {
  add_view("good.png", clay_disc());
  add_mask(kDisc);
  add_view("empty.png", clay_disc());
  add_mask(kEmpty);
  add_view("full.png", clay_disc());
  add_mask(kFull);
  EXPECT_THAT(prepare().warnings,
              testing::ElementsAre(HasSubstr("empty.png: the mask is empty"),
                                   HasSubstr("full.png: the mask is all foreground")));
}

TEST_F(PrepareViews, RejectsAllEmptyMasks) {
  for (const char* name : {"a.png", "b.png"}) {
    add_view(name, clay_disc());
    add_mask(kEmpty);
  }
  EXPECT_THAT(error_of_prepare(), HasSubstr("all masks are empty"));
}

TEST_F(PrepareViews, RejectsInvertedMasks) {
  for (const char* name : {"a.png", "b.png", "c.png"}) {
    add_view(name, clay_disc());
    add_mask(name[0] == 'a' ? kDisc : kInverted);
  }
  EXPECT_THAT(error_of_prepare(), HasSubstr("masks look inverted: in 2 of 3"));
  EXPECT_THAT(error_of_prepare(), HasSubstr("white must be the object"));
}

TEST_F(PrepareViews, RejectsInvertedMasksOfThinObjects) {
  // A stem two pixels wide: the middle of an inverted mask is mostly foreground, too.
  const Mask inverted = paint_mask(kWidth, kHeight, [](double x, double y) {
    return std::abs(x - 31) < 1 && y > 8 && y < 40 ? 0.0 : 1.0;
  });
  for (const char* name : {"a.png", "b.png", "c.png"}) {
    add_view(name, clay_disc());
    add_mask(inverted);
  }
  EXPECT_THAT(error_of_prepare(), HasSubstr("masks look inverted: in 3 of 3"));
  EXPECT_THAT(error_of_prepare(), HasSubstr("masks=none"));
}

TEST_F(PrepareViews, TakesFullMasksThatCutAThingOutOfSomeViews) {
  for (const char* name : {"a.png", "b.png", "c.png", "d.png"}) {
    add_view(name, clay_disc());
    add_mask(name[0] < 'c' ? kFull : paint_mask(kWidth, kHeight, [](double x, double y) {
      return std::hypot(x - 12, y - 12) < 4 ? 0.0 : 1.0;
    }));
  }
  EXPECT_EQ(prepare().views.size(), 4u);
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

TEST_F(PrepareViews, ScalesMasksOfScaledCopies) {
  add_view("a.png", clay_disc());
  // Twice as large, over the same picture: the pixel at (x, y) has the middle (2 x + 0.5, ...).
  add_mask(paint_mask(2 * kWidth, 2 * kHeight, [](double x, double y) {
    return std::clamp((28 - std::hypot(x - 60.5, y - 48.5)) / 2 + 0.5, 0.0, 1.0);
  }));
  const Mask large = prepare().views[0].mask;
  ASSERT_EQ(large.width, kWidth);
  masks_["masks/a.png"] = paint_mask(kWidth / 2, kHeight / 2, [](double x, double y) {
    return std::clamp(7 - std::hypot(x - 14.75, y - 11.75) + 0.5, 0.0, 1.0);
  });
  const Mask small = prepare().views[0].mask;
  ASSERT_EQ(small.height, kHeight);
  // The same place and size: a mask that is half a pixel off would be told.
  for (const Mask& mask : {large, small}) {
    double area = 0, x = 0, y = 0, right = 0;
    for (std::size_t i = 0; i < kDisc.coverage.size(); ++i) {
      area += mask.coverage[i], right += kDisc.coverage[i];
      x += mask.coverage[i] * double(i % kWidth), y += mask.coverage[i] * double(i / kWidth);
    }
    EXPECT_NEAR(x / area, 30, 0.02);
    EXPECT_NEAR(y / area, 24, 0.02);
    EXPECT_NEAR(area / right, 1, 0.01);
  }
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
  const View view = prepare().views[0];
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

// The masks that prepare_views takes, finds and rejects, with pictures from memory.
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "masks/silhouette.h"
#include "views/prepare_views_fixture.h"

namespace photohull {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class PrepareMasks : public PrepareViews {};

const Mask kEmpty = paint_mask(kWidth, kHeight, [](double, double) { return 0.0; });
const Mask kFull = paint_mask(kWidth, kHeight, [](double, double) { return 1.0; });
const Mask kInverted =
    paint_mask(kWidth, kHeight, [](double x, double y) { return 1 - disc(x, y); });

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

TEST_F(PrepareMasks, TakesMaskFilesAsTheyAre) {
  add_view("a.png", with_alpha(clay_disc(), kInverted));
  add_mask(kDisc);
  const PreparedViews prepared = prepare();
  EXPECT_EQ(prepared.views[0].mask.coverage, kDisc.coverage);  // the file, not the alpha channel
  EXPECT_EQ(prepared.mask_source, "mask files");
  EXPECT_EQ(prepared.mask_confidence, 1);
  EXPECT_THAT(prepared.warnings, IsEmpty());
}

TEST_F(PrepareMasks, TakesAlphaThatVaries) {
  add_view("a.png", with_alpha(clay_disc(), kDisc));
  const auto half = paint_half(kWidth, kHeight, [](double, double) { return glm::vec3(2.0f); });
  add_view("b.exr", with_alpha(half, kDisc));
  const PreparedViews prepared = prepare();
  EXPECT_EQ(prepared.mask_source, "alpha channels");
  for (const PreparedView& view : prepared.views) {
    for (std::size_t i = 0; i < kDisc.coverage.size(); ++i)
      ASSERT_NEAR(view.mask.coverage[i], kDisc.coverage[i], 1);
    EXPECT_EQ(view.image.linear(0, 0).a, 1);  // alpha now says what is known: all
    EXPECT_FALSE(view.image.has_alpha);
  }
}

TEST_F(PrepareMasks, FallsBackToTheBackground) {
  add_view("a.png", with_alpha(clay_disc(), kFull));  // a constant alpha channel says nothing
  add_view("b.png", clay_disc());
  const PreparedViews prepared = prepare();
  EXPECT_EQ(prepared.mask_source, "background model");
  EXPECT_GT(prepared.mask_confidence, 0.7);
  for (const PreparedView& view : prepared.views) {
    ASSERT_FALSE(view.mask.empty());
    EXPECT_LT(silhouette_distance(view.mask).pixels[24 * kWidth + 30], -13);
    EXPECT_GT(silhouette_distance(view.mask).pixels[0], 20);
  }
}

TEST_F(PrepareMasks, CutsNoSilhouetteWhereTheSceneSaysSo) {
  for (const char* name : {"a.png", "b.png", "c.png"}) add_view(name, clay_disc());
  scene_.views[1].silhouette = false;
  const PreparedViews prepared = prepare();
  EXPECT_FALSE(prepared.views[0].mask.empty());
  EXPECT_TRUE(prepared.views[1].mask.empty());
  EXPECT_FALSE(prepared.views[2].mask.empty());
}

TEST_F(PrepareMasks, SaysWhichViewsGotWhichMasks) {
  add_view("a.png", clay_disc());
  add_mask(kDisc);
  add_view("b.png", with_alpha(clay_disc(), kDisc));
  add_view("c.png", clay_disc());
  add_view("d.png", clay_disc());
  EXPECT_EQ(prepare().mask_source,
            "mask files (1 views), alpha channels (1 views), background model (2 views)");
}

TEST_F(PrepareMasks, GivesNoMasksWithoutHope) {
  for (const char* name : {"a.png", "b.png"})
    add_view(name, paint_srgb(kWidth, kHeight, [](double, double) { return glm::vec3(0.4f); }));
  const PreparedViews prepared = prepare();
  EXPECT_TRUE(prepared.views[0].mask.empty());
  EXPECT_EQ(prepared.mask_source, "none");
  EXPECT_EQ(prepared.mask_confidence, 0);
  EXPECT_THAT(prepared.warnings, testing::ElementsAre(HasSubstr("2 views have no mask")));
}

TEST_F(PrepareMasks, DropsMasksThatFillMostViews) {
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

TEST_F(PrepareMasks, FoundMasksAreNeverEmpty) {
  for (const char* name : {"a.png", "b.png", "c.png"}) add_view(name, clay_disc());
  add_view("black.png", paint_srgb(kWidth, kHeight, [](double, double) { return glm::vec3(0); }));
  const PreparedViews prepared = prepare();
  EXPECT_FALSE(prepared.views[0].mask.empty());
  EXPECT_TRUE(prepared.views[3].mask.empty());
  ASSERT_EQ(prepared.warnings.size(), 1u);
  EXPECT_THAT(prepared.warnings[0], HasSubstr("black.png"));
}

TEST_F(PrepareMasks, PolicyNoneIgnoresAllMasks) {
  add_view("a.png", with_alpha(clay_disc(), kDisc));
  add_mask(kInverted);
  const PreparedViews prepared = prepare({.masks = MaskPolicy::kNone});
  EXPECT_TRUE(prepared.views[0].mask.empty());
  EXPECT_EQ(prepared.mask_source, "none");
  EXPECT_EQ(prepared.views[0].image.linear(0, 0).a, 1);
}

TEST_F(PrepareMasks, WarnsOfEmptyAndFullMasks) {
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

TEST_F(PrepareMasks, RejectsAllEmptyMasks) {
  for (const char* name : {"a.png", "b.png"}) {
    add_view(name, clay_disc());
    add_mask(kEmpty);
  }
  EXPECT_THAT(error_of_prepare(), HasSubstr("all masks are empty"));
}

TEST_F(PrepareMasks, RejectsInvertedMasks) {
  for (const char* name : {"a.png", "b.png", "c.png"}) {
    add_view(name, clay_disc());
    add_mask(name[0] == 'a' ? kDisc : kInverted);
  }
  EXPECT_THAT(error_of_prepare(), HasSubstr("masks look inverted: in 2 of 3"));
  EXPECT_THAT(error_of_prepare(), HasSubstr("white must be the object"));
}

TEST_F(PrepareMasks, RejectsInvertedMasksOfThinObjects) {
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

TEST_F(PrepareMasks, TakesFullMasksThatCutAThingOutOfSomeViews) {
  for (const char* name : {"a.png", "b.png", "c.png", "d.png"}) {
    add_view(name, clay_disc());
    add_mask(name[0] < 'c' ? kFull : paint_mask(kWidth, kHeight, [](double x, double y) {
      return std::hypot(x - 12, y - 12) < 4 ? 0.0 : 1.0;
    }));
  }
  EXPECT_EQ(prepare().views.size(), 4u);
}

TEST_F(PrepareMasks, ScalesMasksOfScaledCopies) {
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

}  // namespace
}  // namespace photohull

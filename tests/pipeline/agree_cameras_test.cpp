// Photographs without masks, whose cameras are right or off.
#include "pipeline/agree_cameras.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cameras/look_at_cameras.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "pipeline/recording_progress.h"
#include "support/cameras.h"
#include "support/places.h"
#include "views/prepare_views.h"

namespace photohull::pipeline {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class CamerasWithoutMasks : public testing::Test {
 protected:
  /// The temple without its masks, its cameras off by about so many pixels.
  AgreeingCameras agree(double pixels) {
    Scene scene = io::load_scene(test::in_checkout("datasets/templeSparseRing"));
    const ViewLoader loader{[](const auto& file) { return io::read_image(file); },
                            [](const auto& file) { return io::read_mask(file); }};
    std::vector<PreparedView> views = prepare_views(scene, loader, {}, progress_).views;
    for (std::size_t i = 0; i < views.size(); ++i) {
      views[i].mask = {};
      views[i].camera = test::put_off(views[i].camera, pixels, int(i));
    }
    return agree_cameras({}, scene, std::move(views), progress_);
  }

  Progress silent_;
  RecordingProgress progress_{silent_};
};

TEST_F(CamerasWithoutMasks, AreLeftAsTheyAreWhereFeaturesAgree) {
  const AgreeingCameras result = agree(0);
  EXPECT_TRUE(std::isnan(result.findings.mask_disagreement));
  EXPECT_LT(result.findings.features.pixels, 0.25);
  EXPECT_THAT(result.findings.refinement, IsEmpty());
  EXPECT_THAT(progress_.warnings(), IsEmpty());
}

TEST_F(CamerasWithoutMasks, AreRefinedWhereFeaturesShowThatTheyAreOff) {
  const AgreeingCameras result = agree(6);
  EXPECT_GT(result.findings.features.pixels, 2);
  EXPECT_GT(result.findings.moved, 2);
  EXPECT_THAT(progress_.warnings(),
              ElementsAre(testing::AllOf(HasSubstr("the cameras have the photographs' features"),
                                         HasSubstr("the cameras were refined"))));
  Progress silent;
  EXPECT_LT(look_at_features(result.views, silent).pixels, 0.25);
}

}  // namespace
}  // namespace photohull::pipeline

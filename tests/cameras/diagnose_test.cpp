#include "cameras/diagnose.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "io/image_file.h"
#include "io/load_scene.h"
#include "support/scratch_folder.h"
#include "synth/synthesize.h"
#include "views/prepare_views.h"

namespace photohull {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// A textured block seen from two rings, rendered once; each test puts its cameras off.
class Diagnose : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    synth::Spec spec = synth::parse_spec(
        R"({"geometry": {"shape": "block"}, "material": {"faces": true, "contrast": 0.6},
            "cameras": {"rings": [{"count": 8, "elevation": 8},
                                  {"count": 6, "elevation": 38, "phase": 0.5}]}})",
        "test", "");
    spec.image = {320, 240, 2};
    spec.truth_samples = 200;
    ScratchFolder folder;
    Progress progress;
    synth::synthesize(spec, folder / "scene", progress);
    Scene scene = io::load_scene(folder / "scene/transforms.json");
    const ViewLoader loader{[](const fs::path& file) { return io::read_image(file); },
                            [](const fs::path& file) { return io::read_mask(file); }};
    healthy_ = new std::vector<PreparedView>(prepare_views(scene, loader, {}, progress).views);
    box_ = *scene.box;
  }
  static void TearDownTestSuite() {
    delete healthy_;
    healthy_ = nullptr;
  }

  /// The poses as they would be given for these to be read as `reading` says.
  void misread(const PoseReading& reading) {
    for (PreparedView& view : views_) {
      // A flip is its own inverse, and comes last: undone first.
      const Pose flipped = PoseReading{.flipped = reading.flipped}.pose(view.camera.cam_from_world);
      view.camera.cam_from_world = PoseReading{.inverted = reading.inverted}.pose(flipped);
    }
  }

  void shift_principal_points(double by) {
    for (PreparedView& view : views_) {
      view.camera.intrinsics.cx += by;
      view.camera.intrinsics.cy += by;
    }
  }

  CameraDiagnosis diagnose() { return diagnose_cameras(views_, scene_box_, progress_); }

  static std::vector<PreparedView>* healthy_;
  static Box box_;
  std::vector<PreparedView> views_ = *healthy_;
  std::optional<Box> scene_box_ = box_;
  Progress progress_;
};

std::vector<PreparedView>* Diagnose::healthy_ = nullptr;
Box Diagnose::box_;

TEST_F(Diagnose, CamerasInOrderHaveNoFault) {
  const CameraDiagnosis d = diagnose();
  EXPECT_THAT(d.faults, IsEmpty());
  EXPECT_THAT(d.notes, IsEmpty());
  ASSERT_FALSE(d.readings.empty());
  EXPECT_TRUE(d.readings[0].as_given());
  EXPECT_GT(d.given.explained, 0.9);
  EXPECT_LT(d.given.residual, 0.5);
  ASSERT_TRUE(d.pixel_centre);
  EXPECT_TRUE(d.pixel_centre->tells);
  EXPECT_EQ(d.pixel_centre->best, 0);
  EXPECT_NEAR(d.pixel_centre->shift, 0, 0.1);
  ASSERT_TRUE(d.box);
  EXPECT_EQ(d.box->seen_by, int(views_.size()));
  EXPECT_GT(d.box->points_inside, 0.9);
}

TEST_F(Diagnose, NamesTheReadingThatExplainsTheMatches) {
  for (const PoseReading& truth :
       {PoseReading{.inverted = true}, PoseReading{.flipped = {false, true, true}},
        PoseReading{.inverted = true, .flipped = {false, true, true}},
        PoseReading{.flipped = {false, true, false}}}) {
    views_ = *healthy_;
    misread(truth);
    const CameraDiagnosis d = diagnose();
    EXPECT_TRUE(d.misread) << to_string(truth);
    ASSERT_FALSE(d.readings.empty());
    EXPECT_EQ(to_string(d.readings[0]), to_string(truth));
    EXPECT_GT(d.readings[0].explained, 0.9);
    EXPECT_THAT(d.faults, ElementsAre(HasSubstr(to_string(truth))));
    EXPECT_FALSE(d.pixel_centre);
  }
}

TEST_F(Diagnose, TellsWhichPixelCentreFits) {
  for (const double wrong : {-0.5, 0.5}) {
    views_ = *healthy_;
    shift_principal_points(wrong);
    const CameraDiagnosis d = diagnose();
    ASSERT_TRUE(d.pixel_centre);
    EXPECT_TRUE(d.pixel_centre->tells);
    EXPECT_EQ(d.pixel_centre->best, -wrong);
    EXPECT_NEAR(d.pixel_centre->shift, -wrong, 0.1);
    EXPECT_THAT(d.faults, ElementsAre(HasSubstr(wrong < 0 ? "half a pixel too small"
                                                          : "half a pixel too large")));
  }
  views_ = *healthy_;
  shift_principal_points(0.25);  // neither
  const CameraDiagnosis d = diagnose();
  ASSERT_TRUE(d.pixel_centre);
  EXPECT_FALSE(d.pixel_centre->tells);
  EXPECT_THAT(d.notes, ElementsAre(HasSubstr("no pixel centre clearly fits")));
  EXPECT_THAT(d.faults, IsEmpty());
}

/// Turns a camera about its own vertical axis.
void turn(Camera& camera, double pixels) {
  const double angle = pixels / camera.intrinsics.fx, c = std::cos(angle), s = std::sin(angle);
  const glm::dmat3 about_x(1, 0, 0, 0, c, s, 0, -s, c);
  camera.cam_from_world.rotation = about_x * camera.cam_from_world.rotation;
  camera.cam_from_world.translation = about_x * camera.cam_from_world.translation;
}

TEST_F(Diagnose, NamesTheViewsThatDisagree) {
  turn(views_[3].camera, 6);
  turn(views_[12].camera, -9);
  const CameraDiagnosis d = diagnose();
  EXPECT_THAT(d.faults, ElementsAre(StartsWith(views_[3].name), StartsWith(views_[12].name)));
  ASSERT_EQ(d.views.size(), views_.size());
  EXPECT_GT(d.views[3].residual, 3);
  EXPECT_GT(d.views[12].residual, 3);
  EXPECT_LT(d.usual_residual, 0.5);
  for (std::size_t i = 0; i < views_.size(); ++i)
    EXPECT_EQ(d.views[i].disagrees, i == 3 || i == 12) << i;
}

TEST_F(Diagnose, NamesAViewThatIsOffAlongItsEpipolarLines) {
  // Views of a straight row: sideways is along the lines that all pairs have.
  views_.clear();
  for (int i = 0; i < 7; ++i) {
    PreparedView view = (*healthy_)[0];
    const double shift = 12 * i;  // of a flat object's picture
    for (int y = 0; y < view.image.height; ++y)
      for (int x = 0; x < view.image.width; ++x) {
        const int from = std::min(x + int(shift), view.image.width - 1);
        const std::size_t to = std::size_t(y) * view.image.width;
        std::copy_n(&(*healthy_)[0].image.bytes[(to + from) * 4], 4,
                    &view.image.bytes[(to + x) * 4]);
      }
    view.name = std::to_string(i);
    view.mask = {};
    const double depth = 3, f = view.camera.intrinsics.fx;
    view.camera.cam_from_world = {glm::dmat3(1.0), {-shift * depth / f, 0, 0}};
    views_.push_back(view);
  }
  scene_box_.reset();
  EXPECT_THAT(diagnose().faults, IsEmpty());
  views_[2].camera.intrinsics.cx += 6;
  const CameraDiagnosis d = diagnose();
  EXPECT_THAT(d.faults, ElementsAre(StartsWith("2 disagrees")));
  EXPECT_EQ(d.views[2].by, ViewFit::By::kTracks);
  EXPECT_NEAR(d.views[2].residual, 6, 0.5);
}

TEST_F(Diagnose, CamerasThatAreAllALittleOffAreNotMisread) {
  for (std::size_t i = 0; i < views_.size(); ++i) turn(views_[i].camera, i * 7 % 5 - 2.0);
  const CameraDiagnosis d = diagnose();
  EXPECT_FALSE(d.misread);
  EXPECT_GT(d.usual_residual, 0.5);
  EXPECT_THAT(d.faults, IsEmpty());
}

TEST_F(Diagnose, SilhouettesServeWhereThereAreNoMatches) {
  for (PreparedView& view : views_)
    for (std::size_t i = 0; i < view.image.bytes.size(); ++i)
      if (i % view.image.bytes_per_pixel() != 3) view.image.bytes[i] = 0;
  EXPECT_THAT(diagnose().faults, IsEmpty());
  turn(views_[3].camera, 20);
  const CameraDiagnosis d = diagnose();
  EXPECT_TRUE(d.readings.empty());
  EXPECT_THAT(d.faults, ElementsAre(StartsWith(views_[3].name)));
  EXPECT_EQ(d.views[3].by, ViewFit::By::kSilhouettes);
}

TEST_F(Diagnose, SilhouettesAloneNameTheViewThatIsTurned) {
  turn(views_[3].camera, 20);
  views_[5].mask = {};
  std::vector<Camera> cameras;
  for (const PreparedView& view : views_) cameras.push_back(view.camera);
  const std::vector<ViewFit> fits = fit_silhouettes(cameras, views_);
  ASSERT_EQ(fits.size(), views_.size());
  for (std::size_t i = 0; i < fits.size(); ++i) {
    EXPECT_EQ(fits[i].disagrees, i == 3) << i;
    EXPECT_EQ(fits[i].count == 0, i == 5) << i;
  }
  EXPECT_GT(fits[3].residual, 5);
  EXPECT_LT(fits[2].residual, 1);
}

TEST_F(Diagnose, BoxInOtherUnitsAndBoxThatNoCameraSees) {
  views_.resize(5);
  for (const double factor : {1000.0, 0.001}) {
    // About a corner, as the scene's origin need not be in the box.
    const glm::dvec3 origin = box_.min - box_.size();
    scene_box_ = Box{origin + factor * (box_.min - origin), origin + factor * (box_.max - origin)};
    const CameraDiagnosis d = diagnose();
    ASSERT_EQ(d.faults.size(), 1u);
    EXPECT_THAT(d.faults[0], HasSubstr("is it in other units?"));
    ASSERT_TRUE(d.box);
    EXPECT_NEAR(d.box->diagonal / d.box->points_diagonal / factor, 1, 0.6);
  }
  const glm::dvec3 away(0, 0, 100 * box_.diagonal());
  scene_box_ = Box{box_.min + away, box_.max + away};
  const CameraDiagnosis d = diagnose();
  ASSERT_TRUE(d.box);
  EXPECT_EQ(d.box->seen_by, 0);
  EXPECT_THAT(d.faults, ElementsAre(StartsWith("no camera has the box on its image")));
}

}  // namespace
}  // namespace photohull

#include "cameras/refine_cameras.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cameras/diagnose.h"
#include "cameras/frontier.h"
#include "cameras/triangulate.h"
#include "core/error.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "photo/align_patch.h"
#include "support/pictures.h"
#include "support/scratch_folder.h"
#include "synth/synthesize.h"
#include "views/prepare_views.h"

namespace photohull {
namespace {

namespace fs = std::filesystem;

/// Cameras on a circle of radius 5 around the origin, looking at it, z up.
std::vector<Camera> ring(int count) {
  std::vector<Camera> cameras;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    Camera camera;
    camera.intrinsics = {200, 150, 180, 175, 0.5, 98, 76};
    const glm::dvec3 center(5 * std::cos(angle), 5 * std::sin(angle), 0.7 + 0.3 * (i % 3));
    const glm::dvec3 z = -glm::normalize(center), x = glm::normalize(glm::cross(z, {0, 0, 1})),
                     y = glm::cross(z, x);
    camera.cam_from_world.rotation = glm::transpose(glm::dmat3(x, y, z));
    camera.cam_from_world.translation = -(camera.cam_from_world.rotation * center);
    cameras.push_back(camera);
  }
  return cameras;
}

Track track_of(std::span<const Camera> cameras, const glm::dvec3& point) {
  Track track;
  for (int i = 0; i < int(cameras.size()); ++i)
    track.observations.push_back({i, *cameras[i].project(point)});
  return track;
}

/// How far, in pixels, cameras are from consistent with the true ones, whatever world each has:
/// points near the origin are seen by the true ones and triangulated by the others.
double inconsistency(std::span<const Camera> cameras, std::span<const Camera> truth, double size) {
  double sum = 0;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 point = size * glm::dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    const Track track = track_of(truth, point);
    const auto found = triangulate(cameras, track);
    sum += found ? std::pow(reprojection_rms(cameras, track, *found), 2) : 1e9;
  }
  return std::sqrt(sum / 8);
}

TEST(Triangulate, FindsThePointThatItsPixelsShow) {
  const std::vector<Camera> cameras = ring(4);
  const glm::dvec3 point(0.3, -0.2, 0.5);
  const Track track = track_of(cameras, point);
  const auto found = triangulate(cameras, track);
  ASSERT_TRUE(found);
  EXPECT_LT(glm::distance(*found, point), 1e-9);
  EXPECT_LT(reprojection_rms(cameras, track, *found), 1e-9);
}

TEST(Triangulate, RefusesParallelRays) {
  std::vector<Camera> cameras = {ring(4)[0], ring(4)[0]};
  EXPECT_FALSE(triangulate(cameras, track_of(cameras, {0.1, 0.2, 0})));
}

GreyImage waves(double dx, double dy, double gain) {
  GreyImage image{60, 50, {}};
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 60; ++x) {
      const double u = x - dx, v = 1.02 * (y - dy);
      image.values.push_back(
          float(gain * (100 + 30 * std::sin(0.5 * u) + 25 * std::sin(0.4 * v + 0.2 * u)) + 5));
    }
  return image;
}

TEST(AlignPatch, FindsShiftsBelowAPixelUnderGainAndOffset) {
  const GreyImage a = waves(0, 0, 1), b = waves(0.37, -0.21, 1.3);
  const glm::dvec2 source(30, 24);
  const auto found = align_patch(a, source, b, {{30, 24}, glm::dmat2(1)}, 7, 3);
  ASSERT_TRUE(found);
  // The second image is squeezed along y: 1.02 (y + 0.21) = 1.02 * 24.
  EXPECT_NEAR(found->place.center.x, 30.37, 0.02);
  EXPECT_NEAR(found->place.center.y, 24 - 0.21, 0.02);
  EXPECT_GT(found->agreement, 0.99);
}

TEST(AlignPatch, RefusesPatchesWithoutStructureAndBeyondTheFrame) {
  GreyImage plain{60, 50, std::vector<float>(3000, 80.0f)};
  EXPECT_FALSE(align_patch(plain, {30, 24}, plain, {{30, 24}, glm::dmat2(1)}, 7, 3));
  const GreyImage image = waves(0, 0, 1);
  EXPECT_FALSE(align_patch(image, {5, 24}, image, {{5, 24}, glm::dmat2(1)}, 7, 3));
}

/// The silhouette of a sphere around the origin, exact to rounding of coverage.
Mask sphere_mask(const Camera& camera, double radius) {
  const glm::dvec3 c = camera.center();
  return paint_mask(camera.intrinsics.width, camera.intrinsics.height, [&](double x, double y) {
    double inside = 0;
    for (int i = 0; i < 64; ++i) {
      const glm::dvec3 d = camera.ray({x + (i % 8 - 3.5) / 8, y + (i / 8 - 3.5) / 8});
      inside += glm::length(glm::cross(c, d)) < radius;
    }
    return inside / 64;
  });
}

TEST(Frontier, TangentsOfASphereLieOnEachOthersEpipolarLines) {
  std::vector<Camera> cameras = ring(6);
  std::vector<Outline> outlines;
  for (const Camera& camera : cameras) outlines.push_back(outline_of(sphere_mask(camera, 1.2)));
  const std::vector<FrontierPair> pairs = frontier_pairs(cameras, outlines);
  // Opposite views have each other's epipole within the outline, but for two that are so high that
  // the line between them passes above the sphere.
  ASSERT_EQ(pairs.size(), 2u * (15 - 2));
  double sum = 0;
  for (const FrontierPair& pair : pairs) {
    const glm::dvec2 d = epipolar_distances(cameras[pair.view_a], cameras[pair.view_b], pair);
    sum += glm::dot(d, d);
  }
  EXPECT_LT(std::sqrt(sum / (2 * double(pairs.size()))), 0.1);
  // A camera that is off by pixels shows.
  cameras[0].intrinsics.cy += 3;
  const auto off = epipolar_distances(cameras[0], cameras[1], frontier_pairs(cameras, outlines)[0]);
  EXPECT_GT(glm::length(off), 1.5);
}

class RefineCameras : public testing::Test {
 protected:
  /// A block photographed from two rings, its cameras put off as `degradations` says.
  void synthesize(const std::string& material, const std::string& degradations) {
    synth::Spec spec =
        synth::parse_spec(R"({"geometry": {"shape": "block"}, "material": )" + material +
                              R"(, "cameras": {"rings": [{"count": 9, "elevation": 5},
                {"count": 9, "elevation": 35, "phase": 0.5}]}, "degradations": )" +
                              degradations + "}",
                          "test", "");
    spec.image = {320, 240, 3};
    spec.truth_samples = 200;
    synth::synthesize(spec, folder_ / "scene", progress_);
    scene_ = io::load_scene(folder_ / "scene/transforms.json");
    const fs::path exact = folder_ / "scene/true_cameras/transforms.json";
    truth_ = cameras_of(fs::exists(exact) ? io::load_scene(exact) : scene_);
    const ViewLoader loader{[](const fs::path& file) { return io::read_image(file); },
                            [](const fs::path& file) { return io::read_mask(file); }};
    views_ = prepare_views(scene_, loader, {}, progress_).views;
  }

  static std::vector<Camera> cameras_of(const Scene& scene) {
    std::vector<Camera> cameras;
    for (const SourceView& view : scene.views) cameras.push_back(view.camera);
    return cameras;
  }

  double error(std::span<const Camera> cameras) const {
    return inconsistency(cameras, truth_, 0.5);
  }

  ScratchFolder folder_;
  Progress progress_;
  Scene scene_;
  std::vector<PreparedView> views_;
  std::vector<Camera> truth_;
};

constexpr const char* kTextured = R"({"faces": true, "contrast": 0.6})";
constexpr const char* kPlain = R"({"contrast": 0, "chroma": 0})";

TEST_F(RefineCameras, PosesThatAreTwoPixelsOffBecomeConsistent) {
  synthesize(kTextured, R"({"pose_error": 2})");
  ASSERT_GT(error(cameras_of(scene_)), 1);
  const CameraRefinement found = refine_cameras(views_, {}, progress_);
  EXPECT_TRUE(found.changed);
  EXPECT_LT(error(found.cameras), 0.1);
  EXPECT_GT(found.all.before, 0.5);
  EXPECT_LT(found.all.after, 0.15);
  EXPECT_LT(found.moved_alike, 0.5 * found.moved);
  ASSERT_EQ(found.views.size(), scene_.views.size());
  for (const ViewAgreement& view : found.views)
    if (view.observations > 5) {
      EXPECT_LT(view.after, view.before + 0.1);
    }
  // The gauge is that of the given cameras: points stay where they were, but for the noise's mean.
  const glm::dvec3 point(0.1, 0.2, 0.3);
  double shift = 0;
  for (std::size_t i = 0; i < truth_.size(); ++i)
    shift += glm::distance(*found.cameras[i].project(point), *truth_[i].project(point));
  EXPECT_LT(shift / double(truth_.size()), 1.5);
}

TEST_F(RefineCameras, OutlinesTellHowFarAViewIsOff) {
  synthesize(kTextured, R"({"view_shift": 2, "view_shift_views": 0.12})");
  const std::vector<double> off = outlines_off(cameras_of(scene_), views_);
  ASSERT_EQ(off.size(), views_.size());
  for (std::size_t i = 0; i < off.size(); ++i) {
    const Intrinsics given = views_[i].camera.intrinsics, right = truth_[i].intrinsics;
    const double shift = std::hypot(given.cx - right.cx, given.cy - right.cy);
    if (shift < 0.1)
      EXPECT_EQ(off[i], 0) << i;
    else
      EXPECT_NEAR(off[i], shift, 0.6) << i;
  }
  EXPECT_THAT(outlines_off(truth_, views_), testing::Each(0));
}

TEST_F(RefineCameras, ViewsThatAreHeldHoldTheOthers) {
  synthesize(kTextured, R"({"view_shift": 2, "view_shift_views": 0.12})");
  const std::vector<double> off = outlines_off(cameras_of(scene_), views_);
  RefineCamerasOptions options;
  for (std::size_t i = 0; i < off.size(); ++i)
    if (off[i] == 0) options.held.push_back(int(i));
  const CameraRefinement found = refine_cameras(views_, options, progress_);
  int moved = 0;
  for (std::size_t i = 0; i < off.size(); ++i) {
    if (off[i] == 0) {
      EXPECT_EQ(found.cameras[i].cam_from_world.translation,
                views_[i].camera.cam_from_world.translation);
      EXPECT_EQ(found.cameras[i].cam_from_world.rotation, views_[i].camera.cam_from_world.rotation);
      continue;
    }
    ++moved;
    // On the side that the view shows: before a flat side a turn and a move look alike, and what
    // lies deeper is told by nothing.
    const glm::dvec3 point = 0.4 * glm::normalize(truth_[i].center());
    const glm::dvec2 right = *truth_[i].project(point);
    EXPECT_GT(glm::distance(*views_[i].camera.project(point), right), 1.5);
    EXPECT_LT(glm::distance(*found.cameras[i].project(point), right), 0.3);
  }
  EXPECT_EQ(moved, 2);
  EXPECT_THAT(outlines_off(found.cameras, views_), testing::Each(0));
}

TEST_F(RefineCameras, ExactCamerasStayAlmostAsTheyAre) {
  synthesize(kTextured, "{}");
  EXPECT_LT(error(refine_cameras(views_, {}, progress_).cameras), 0.06);
}

TEST_F(RefineCameras, SilhouettesServeWhereThereIsNoTexture) {
  synthesize(kPlain, R"({"pose_error": 2})");
  const double before = error(cameras_of(scene_));
  const CameraRefinement found = refine_cameras(views_, {}, progress_);
  EXPECT_TRUE(found.changed);
  EXPECT_LT(error(found.cameras), 0.6 * before);
  EXPECT_LT(found.tangents_after, 0.3 * found.tangents_before);
}

TEST_F(RefineCameras, FocalLengthAndPrincipalPointOnDemand) {
  synthesize(kTextured, R"({"intrinsics_error": 3})");
  const double before = error(cameras_of(scene_));
  RefineCamerasOptions options;
  options.intrinsics = SharedIntrinsics::kAll;
  const CameraRefinement found = refine_cameras(views_, options, progress_);
  EXPECT_LT(error(found.cameras), 0.25 * before);
  EXPECT_NE(found.focal_factor, 1);
  EXPECT_EQ(refine_cameras(views_, {}, progress_).focal_factor, 1);
}

TEST_F(RefineCameras, WhatAllViewsShareIsFoundUnasked) {
  synthesize(kTextured, R"({"intrinsics_error": 3})");
  RefineCamerasOptions options;
  options.intrinsics = SharedIntrinsics::kWhereAlike;
  const CameraRefinement found = refine_cameras(views_, options, progress_);
  const Intrinsics given = scene_.views[0].camera.intrinsics, right = truth_[0].intrinsics;
  EXPECT_NEAR(found.principal.x, right.cx - given.cx, 0.15 * std::abs(right.cx - given.cx) + 0.1);
  EXPECT_NEAR(found.principal.y, right.cy - given.cy, 0.15 * std::abs(right.cy - given.cy) + 0.1);
  const glm::dvec2 off(right.cx - given.cx, right.cy - given.cy);
  EXPECT_LT(glm::distance(found.principal, off), 0.25);  // what is left holds the poses
  EXPECT_NEAR(found.focal_factor, right.fx / given.fx, 0.005);
  EXPECT_LT(found.moved, 0.5);  // poses were right
  // And the world stays where the poses have it.
  const glm::dvec3 point(0.1, 0.2, 0.3);
  for (std::size_t i = 0; i < truth_.size(); ++i)
    EXPECT_LT(glm::distance(*found.cameras[i].project(point), *truth_[i].project(point)), 0.5);
}

TEST_F(RefineCameras, ErrorsOfPosesAreNotTakenForSharedOnes) {
  synthesize(kTextured, R"({"pose_error": 2})");
  RefineCamerasOptions options;
  options.intrinsics = SharedIntrinsics::kWhereAlike;
  EXPECT_EQ(refine_cameras(views_, options, progress_).focal_factor, 1);
}

TEST_F(RefineCameras, PatchesOfTheHullServeWhereTextureIsFaint) {
  synthesize(R"({"contrast": 0.03, "chroma": 0})", R"({"pose_error": 2})");
  const double before = error(cameras_of(scene_));
  const double without = error(refine_cameras(views_, {}, progress_).cameras);
  RefineCamerasOptions options;
  options.box = scene_.box;
  const CameraRefinement found = refine_cameras(views_, options, progress_);
  RecordProperty("without", std::to_string(without));
  RecordProperty("with", std::to_string(error(found.cameras)));
  EXPECT_GT(found.patches, 50);
  EXPECT_LT(error(found.cameras), 0.85 * without);
  EXPECT_LT(error(found.cameras), 0.2 * before);
}

TEST_F(RefineCameras, PatchesStayAwayWhereFeaturesAreMany) {
  synthesize(kTextured, R"({"pose_error": 1})");
  RefineCamerasOptions options;
  options.box = scene_.box;
  options.few_features = 1;
  EXPECT_EQ(refine_cameras(views_, options, progress_).patches, 0);
}

TEST_F(RefineCameras, GivenTracksServeAlone) {
  synthesize(kTextured, R"({"pose_error": 2})");
  // Tracks as another program would have found them: a pixel off, by the exact cameras.
  RefineCamerasOptions options;
  options.source = TrackSource::kGiven;
  const std::vector<Track> found = find_tracks(views_, {}, progress_);
  for (std::size_t i = 0; i < found.size(); i += 2) {
    options.given.push_back(found[i]);
    for (Observation& o : options.given.back().observations)
      o.pixel += 0.5 * glm::dvec2(std::sin(7.0 * double(i + o.view)), std::cos(3.0 * double(i)));
  }
  const CameraRefinement refined = refine_cameras(views_, options, progress_);
  EXPECT_EQ(refined.given_tracks, int(options.given.size()));
  EXPECT_LE(refined.tracks, int(options.given.size()));
  EXPECT_LT(error(refined.cameras), 0.15);
  // Given ones are not found a second time.
  options.source = TrackSource::kBoth;
  const CameraRefinement both = refine_cameras(views_, options, progress_);
  EXPECT_GT(both.tracks, refined.tracks);
  EXPECT_LT(both.tracks, int(found.size() + options.given.size()));
  options.source = TrackSource::kFound;
  EXPECT_EQ(refine_cameras(views_, options, progress_).given_tracks, 0);
}

TEST_F(RefineCameras, PixelCentreAlone) {
  synthesize(kTextured, "{}");
  // The file's writer counted pixels from their corners.
  for (PreparedView& view : views_)
    view.camera.intrinsics.cx += 0.5, view.camera.intrinsics.cy += 0.5;
  RefineCamerasOptions options;
  options.intrinsics = SharedIntrinsics::kPixelCentre;
  const CameraRefinement found = refine_cameras(views_, options, progress_);
  EXPECT_NEAR(found.principal.x, -0.5, 0.1);
  EXPECT_NEAR(found.principal.y, -0.5, 0.1);
  EXPECT_EQ(found.focal_factor, 1);
}

TEST_F(RefineCameras, PrincipalPointsThatAreOffAlikeShowInWhatAllViewsMovedBy) {
  synthesize(kTextured, "{}");
  for (PreparedView& view : views_) view.camera.intrinsics.cx += 3;
  const CameraRefinement found = refine_cameras(views_, {}, progress_);
  ASSERT_TRUE(found.changed);
  EXPECT_GT(found.moved_alike, 0.8 * found.moved);
  EXPECT_NEAR(found.moved_alike, 3, 0.6);
}

TEST_F(RefineCameras, WhatDoesNotAgreeBetterIsNotTaken) {
  synthesize(kTextured, "{}");
  // Given tracks of which all lie: nothing held out may become better by following them.
  RefineCamerasOptions options;
  options.source = TrackSource::kGiven;
  for (int i = 0; i < 200; ++i) {
    Track track;
    for (int v = 0; v < 3; ++v)
      track.observations.push_back(
          {(i + v) % int(views_.size()), {100 + (i * 37 + v * 11) % 120, 60 + (i * 53) % 110}});
    std::sort(track.observations.begin(), track.observations.end(),
              [](const auto& a, const auto& b) { return a.view < b.view; });
    options.given.push_back(track);
  }
  const CameraRefinement found = refine_cameras(views_, options, progress_);
  EXPECT_LT(error(found.cameras), 0.3);
  EXPECT_TRUE(!found.changed || found.all.after < found.all.before ||
              found.tangents_after < found.tangents_before);
}

TEST_F(RefineCameras, NeedsThreeViews) {
  synthesize(kTextured, "{}");
  EXPECT_THROW(refine_cameras(std::span(views_).first(2), {}, progress_), Error);
}

}  // namespace
}  // namespace photohull

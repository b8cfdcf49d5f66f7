// Sequences: what moves from frame to frame, and what does not.
#include "synth/motion.h"

#include <gtest/gtest.h>

#include <map>

#include "core/error.h"
#include "io/load_scene.h"
#include "support/scratch_folder.h"
#include "synth/place_cameras.h"
#include "synth/synthesize.h"

namespace photohull::synth {
namespace {

namespace fs = std::filesystem;

/// A block that grows, or what else is said of its motion.
Spec sequence(const std::string& motion, const std::string& more = "") {
  Spec spec = parse_spec(R"({"geometry": {"shape": "block"}, "motion": )" + motion + R"(,
      "cameras": {"layout": "arc", "count": 3, "arc": 60, "roll": 10})" +
                             more + "}",
                         "test", "");
  spec.image = {64, 48, 1};
  spec.truth_samples = 500;
  return spec;
}

constexpr const char* kGrowing = R"({"height": [1.0, 1.6]})";

std::vector<fs::path> make_frames(const Spec& spec, const fs::path& folder, int count) {
  std::vector<fs::path> folders;
  for (int i = 0; i < count; ++i) folders.push_back(folder / ("000" + std::to_string(i)));
  Progress silent;
  synthesize_frames(spec, folders, silent);
  return folders;
}

/// Of a file that must be there.
std::string bytes(const fs::path& file) {
  EXPECT_TRUE(fs::exists(file)) << file;
  return read_text(file);
}

TEST(Motion, ValuesAreSpreadEvenlyAndTheLastFrameIsBeforeTheEnd) {
  Spec spec = sequence(
      R"({"height": [1.0, 1.6], "rotate": [[0, 0, 0], [0, 0, 360]], "translate": [[1, 0, 0], [1, 0, 2]]})");
  EXPECT_EQ(geometry_of_frame(spec, 0).parameters.at("height"), 1.0);
  spec.moment.frames = 4;
  const GeometrySpec third = geometry_of_frame(spec, 3);
  EXPECT_NEAR(third.parameters.at("height"), 1.45, 1e-12);
  EXPECT_EQ(third.parameters.at("width"), 2.0);
  EXPECT_EQ(third.rotate, glm::dvec3(0, 0, 270));
  EXPECT_EQ(third.translate, glm::dvec3(1, 0, 1.5));
}

TEST(Motion, FramesShareCamerasAndBoxAndHaveTheirOwnTruth) {
  const ScratchFolder scratch;
  const Spec spec =
      sequence(kGrowing, R"(, "degradations": {"pose_error": 1, "missing_views": [0]})");
  const auto folders = make_frames(spec, scratch / "out", 3);
  for (const char* file : {"transforms.json", "bbox.txt", "true_cameras/transforms.json",
                           "colmap_text/images.txt", "middlebury/scene_par.txt"})
    for (const std::size_t i : {1u, 2u})
      EXPECT_EQ(bytes(folders[0] / file), bytes(folders[i] / file)) << file;
  EXPECT_NE(bytes(folders[0] / "gt.ply"), bytes(folders[1] / "gt.ply"));
  EXPECT_NE(bytes(folders[0] / "images/0001.png"), bytes(folders[1] / "images/0001.png"));
  // Around the highest block, that of the last frame.
  const Box box = *io::load_scene(folders[0]).box;
  const double margin = 0.02 * length(glm::dvec3(2, 1.2, 1.4));
  EXPECT_NEAR(box.max.z, 1.4 + margin, 1e-6);
  EXPECT_NEAR(box.min.z, -margin, 1e-6);
}

TEST(Motion, SpecOfAFrameMakesItAgain) {
  const ScratchFolder scratch;
  const Spec spec = sequence(kGrowing, R"(, "degradations": {"read_noise": 0.01})");
  const auto folders = make_frames(spec, scratch / "out", 2);
  Progress silent;
  synthesize(read_spec(folders[1] / "spec.json"), scratch / "again", silent);
  for (const char* file : {"images/0000.png", "masks/0002.png", "gt.ply", "transforms.json",
                           "depth/0001.exr", "spec.json"})
    EXPECT_EQ(bytes(folders[1] / file), bytes(scratch / "again" / file)) << file;
}

TEST(Motion, NoiseAndHolesOfMasksDifferWhereNothingMoves) {
  const ScratchFolder scratch;
  const Spec spec = sequence("{}", R"(, "background": {"plates": true}, "degradations":
      {"read_noise": 0.02, "exposure": 0.3, "mask_holes": 2})");
  const auto folders = make_frames(spec, scratch / "out", 2);
  for (const char* file : {"images/0000.png", "plates/0000.png", "masks/0000.png"})
    EXPECT_NE(bytes(folders[0] / file), bytes(folders[1] / file)) << file;
  for (const char* file : {"gt.ply", "gt_visible.ply", "depth/0000.exr", "transforms.json"})
    EXPECT_EQ(bytes(folders[0] / file), bytes(folders[1] / file)) << file;
  // The first frame is the scene without frames.
  Progress silent;
  synthesize(spec, scratch / "still", silent);
  for (const char* file : {"images/0000.png", "plates/0000.png", "masks/0000.png", "bbox.txt"})
    EXPECT_EQ(bytes(folders[0] / file), bytes(scratch / "still" / file)) << file;
}

TEST(Motion, PatternGoesWithWhatTurnsAndMoves) {
  Spec spec = sequence(R"({"rotate": [[10, 0, 0], [10, 0, 90]], "translate": [[1, 2, 3], [4, 2, 3]],
                           "height": [1.3, 1.3]})");
  spec.moment = {0, 3};
  Progress silent;
  const auto all = box_of_frames(spec, silent);
  ASSERT_TRUE(all);
  const Surface first = surface_at_moment(spec, all);
  spec.moment.frame = 2;
  const Surface last = surface_at_moment(spec, all);
  EXPECT_EQ(first.diagonal, last.diagonal);
  EXPECT_EQ(first.own.diagonal, last.own.diagonal);
  for (const std::size_t i : {0u, 17u, 230u}) {
    EXPECT_GT(length(first.mesh.world(i) - last.mesh.world(i)), 0.5);
    EXPECT_LT(length(first.own.place(first.mesh.world(i)) - last.own.place(last.mesh.world(i))),
              1e-5);
  }
  // At the first frame patterns lie as they do in a scene that stands still.
  EXPECT_LT(length(first.own.place(all->center())), 1e-12);
  EXPECT_EQ(first.own.rotation, glm::dmat3(1.0));
}

TEST(Motion, NothingMovesWithoutFrames) {
  Spec spec = sequence(R"({"height": [1.6, 1.0]})");
  EXPECT_FALSE(moves(spec));
  Progress silent;
  EXPECT_FALSE(box_of_frames(spec, silent));
  EXPECT_NEAR(surface_at_moment(spec, std::nullopt).box.max.z, 1.6, 1e-6);
  spec.moment.frames = 2;
  EXPECT_TRUE(moves(spec));
  spec.motion = {};
  EXPECT_FALSE(moves(spec));
}

TEST(Motion, AllFramesAreInSight) {
  Spec spec = sequence(R"({"translate": [[0, 0, 0], [9, 0, 0]]})");
  spec.moment = {0, 3};
  Progress silent;
  const auto all = box_of_frames(spec, silent);
  std::vector<LensCamera> before;
  for (; spec.moment.frame < 3; ++spec.moment.frame) {
    const Surface surface = surface_at_moment(spec, all);
    const std::vector<LensCamera> cameras = place_cameras(spec, surface);
    for (std::size_t view = 0; view < cameras.size(); ++view) {
      for (std::size_t i = 0; i < surface.mesh.positions.size(); ++i) {
        const auto pixel = cameras[view].project(surface.mesh.world(i));
        ASSERT_TRUE(pixel && pixel->x > 0 && pixel->x < 63 && pixel->y > 0 && pixel->y < 47);
      }
      if (before.empty()) continue;
      EXPECT_EQ(cameras[view].camera.center(), before[view].camera.center());
      EXPECT_EQ(cameras[view].camera.intrinsics.fx, before[view].camera.intrinsics.fx);
    }
    before = cameras;
  }
}

TEST(Motion, StoppedItLeavesWhatIsDone) {
  const ScratchFolder scratch;
  struct StopAtSecond : Progress {
    void stage(const std::string& name, double weight) override {
      heard[name] = weight;
      if (name == "frame 0001: photographs") process_cancellation().cancel();
    }
    std::map<std::string, double> heard;
  } stopping;
  EXPECT_THROW(synthesize_frames(sequence(kGrowing),
                                 {scratch / "0000", scratch / "0001", scratch / "0002"}, stopping),
               Cancelled);
  process_cancellation().reset();
  EXPECT_TRUE(fs::exists(scratch / "0000/spec.json"));
  EXPECT_FALSE(fs::exists(scratch / "0000/INCOMPLETE"));
  EXPECT_TRUE(fs::exists(scratch / "0001/INCOMPLETE"));
  EXPECT_FALSE(fs::exists(scratch / "0002"));
  EXPECT_EQ(stopping.heard.count("box of all frames"), 1u);
}

TEST(Motion, StagesWeighWhatWasSaid) {
  const ScratchFolder scratch;
  struct Summing : Progress {
    void stage(const std::string&, double weight) override { sum += weight; }
    double sum = 0;
  } summing;
  const Spec spec = sequence(kGrowing);
  synthesize_frames(spec, {scratch / "0", scratch / "1"}, summing);
  EXPECT_NEAR(summing.sum, sequence_weight(spec, 2), 1e-9);
}

}  // namespace
}  // namespace photohull::synth

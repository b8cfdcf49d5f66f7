// Synthesized scenes through the program itself.
#include "sphere_scene.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Synthesize : public SphereScene {
 protected:
  std::string spec(const std::string& text) const {
    write_bytes(path("spec.json"), text);
    return path("spec.json");
  }
};

TEST_F(Synthesize, SceneIsUnderstoodAndReconstructed) {
  const std::string file = spec(R"({"geometry": {"shape": "torus"}, "truth_samples": 1000,
      "image": {"samples": 2}})");
  const Finished made = succeed({"synthesize", file, "--out", path("scene"), "--views", "8",
                                 "--size", "96x72", "--seed", "4"});
  EXPECT_THAT(made.out, HasSubstr("8 views"));
  const Finished info = succeed({"info", path("scene")});
  EXPECT_THAT(info.out, HasSubstr("96 x 72 pixels"));
  EXPECT_THAT(info.out, HasSubstr("8 of 8 views"));
  EXPECT_EQ(info.out.find("warning"), std::string::npos) << info.out;
  succeed({"reconstruct", path("scene"), "--out", path("result"), "--method", "hull",
           "--resolution", "48"});
  EXPECT_TRUE(fs::exists(path("result/mesh.ply")));
  const Finished score =
      succeed({"evaluate", path("result/mesh.ply"), "--truth", path("scene/gt.ply")});
  EXPECT_NE(score.out, "");
}

TEST_F(Synthesize, LightsLookThroughMaps) {
  const auto make = [&](const std::string& test, const std::string& name) {
    const std::string file = spec(R"({"geometry": {"shape": "block"}, "truth_samples": 1000,
        "light": {"shadow_test": ")" +
                                  test + R"("}, "image": {"samples": 2}})");
    succeed({"synthesize", file, "--out", path(name), "--views", "4", "--size", "96x72", "--device",
             "software"});
  };
  make("rays", "rays");
  make("recommended", "maps");
  make("recommended", "again");
  const std::string view = "/images/0001.png";
  EXPECT_EQ(read_bytes(path("maps" + view)), read_bytes(path("again" + view)));
  EXPECT_NE(read_bytes(path("maps" + view)), read_bytes(path("rays" + view)));
  EXPECT_EQ(read_bytes(path("maps/gt.ply")), read_bytes(path("rays/gt.ply")));
  EXPECT_THAT(read_bytes(path("maps/spec.json")), HasSubstr("\"shadow_test\": \"recommended\""));
}

TEST_F(Synthesize, FramesOfASequenceAreScenes) {
  const std::string file = spec(R"({"geometry": {"shape": "torus"}, "motion": {"tube": [0.3, 0.5]},
      "truth_samples": 1000, "image": {"samples": 1}})");
  const Finished made = succeed({"synthesize", file, "--out", path("ring"), "--views", "6",
                                 "--size", "96x72", "--frames", "08-10"});
  EXPECT_THAT(made.out, HasSubstr("3 frames of 6 views"));
  EXPECT_EQ(listing(path("ring")).size(), listing(path("ring/08")).size() * 3 + 3);
  EXPECT_EQ(read_bytes(path("ring/08/transforms.json")),
            read_bytes(path("ring/10/transforms.json")));
  EXPECT_NE(read_bytes(path("ring/08/gt.ply")), read_bytes(path("ring/10/gt.ply")));
  const Finished info = succeed({"info", path("ring/09")});
  EXPECT_THAT(info.out, HasSubstr("6 of 6 views"));
}

TEST_F(Synthesize, ShapesAreListed) {
  const Finished list = succeed({"synthesize", "--list"});
  for (const char* word : {"gyroid", "plant", "radius", "0.01 to 100"})
    EXPECT_THAT(list.out, HasSubstr(word));
}

TEST_F(Synthesize, WrongUsageAndSpecsAreNamed) {
  const std::string file = spec(R"({"cameras": {"fil": 0.5}})");
  fail(1, {"synthesize", file, "--out", out()}, {"spec.json", "cameras.fil", "did you mean fill?"});
  fail(1, {"synthesize", path("none.json"), "--out", out()}, {"none.json", "no such file"});
  fail(2, {"synthesize", file}, {"--out is missing"});
  fail(2, {"synthesize"}, {"a spec is missing"});
  const std::string right = spec("{}");
  fail(2, {"synthesize", right, "--out", out(), "--size", "640"}, {"--size 640"});
  fail(2, {"synthesize", right, "--out", out(), "--size", "640x480x2"}, {"--size"});
  fail(2, {"synthesize", right, "--out", out(), "--views", "0"}, {"--views 0"});
  fail(2, {"synthesize", right, "--out", out(), "--frames", "9-3"}, {"--frames 9-3", "0000-0059"});
  const std::string moving = spec(R"({"motion": {"radus": [1, 2]}})");
  fail(1, {"synthesize", moving, "--out", out(), "--frames", "0-3"},
       {"spec.json", "motion.radus", "did you mean radius?"});
  fail(2, {"synthesize", right, "--out", out(), "--threads", "-1"}, {"--threads -1"});
}

}  // namespace
}  // namespace photohull::test

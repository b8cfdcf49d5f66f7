// Films and stills of a result.
#include <cmath>
#include <csignal>
#include <filesystem>

#include "io/image_file.h"
#include "reconstruct_fixture.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr int kGrey = 96;  // of the background

class Render : public Reconstruct {
 protected:
  void SetUp() override { succeed(reconstruct({"--method", "hull"})); }

  ColourImage still(const Arguments& more) const {
    Arguments all = {"render", out(), "--picture", path("still.png")};
    all.insert(all.end(), more.begin(), more.end());
    EXPECT_EQ(succeed(all).out, path("still.png") + "\n");
    return io::read_image(path("still.png"));
  }
  void refuse(int code, const Arguments& arguments, const std::vector<std::string>& parts) const {
    const Finished run = run_photohull(arguments);
    EXPECT_EQ(run.code, code) << run.err;
    for (const std::string& part : parts) EXPECT_THAT(run.err, HasSubstr(part));
    EXPECT_THAT(run.out, IsEmpty());
  }
};

bool is_background(const ColourImage& image, int x, int y, int grey = kGrey) {
  const std::uint8_t* p =
      &image.bytes[4 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x))];
  return p[0] == grey && p[1] == grey && p[2] == grey;
}

TEST_F(Render, StillFromACameraLiesOverItsPhotograph) {
  const ColourImage drawn = still({"--camera", scene_.views[3].name});
  ASSERT_EQ(drawn.width, kWidth);
  ASSERT_EQ(drawn.height, kHeight);
  const FileMask mask = io::read_mask(mask_file(3));
  const ColourImage photograph = io::read_image(image(3));
  int wrong = 0, inside = 0;
  double difference = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const std::size_t i = std::size_t(y) * kWidth + std::size_t(x);
      const bool object = mask.coverage[i] > 127;
      wrong += is_background(drawn, x, y) == object;
      if (!object) continue;
      ++inside;
      difference += std::abs(int(drawn.bytes[4 * i]) - int(photograph.bytes[4 * i]));
    }
  EXPECT_LT(wrong, 0.03 * kWidth * kHeight);
  EXPECT_GT(inside, 500);
  EXPECT_LT(difference / inside, 25);
  EXPECT_EQ(still({"--camera", "3"}).bytes, drawn.bytes) << "by its index, and the same every time";
}

TEST_F(Render, StillsTakeSizeClayAndBackground) {
  const ColourImage colours = still({"--size", "80x60"});
  EXPECT_EQ(colours.width, 80);
  EXPECT_TRUE(is_background(colours, 0, 0));
  EXPECT_FALSE(is_background(colours, 40, 30));
  const ColourImage clay = still({"--size", "80x60", "--clay", "--background", "#fffFff"});
  EXPECT_TRUE(is_background(clay, 0, 0, 255));
  EXPECT_NE(clay.bytes, colours.bytes);
}

TEST_F(Render, TurntableIsAsManyPictures) {
  succeed(
      {"render", out(), "--turntable", path("turn/%03d.png"), "--frames", "4", "--size", "64x48"});
  EXPECT_THAT(listing(path("turn")),
              testing::ElementsAre("000.png", "001.png", "002.png", "003.png"));
  EXPECT_NE(read_bytes(path("turn/000.png")), read_bytes(path("turn/002.png")));
}

TEST_F(Render, DrawsTheTextureWhereThereIsOne) {
  const ColourImage vertices = still({"--camera", "3"});
  succeed(reconstruct({"--method", "hull", "--export", "glb"}));
  const ColourImage textured = still({"--camera", "3"});
  EXPECT_NE(textured.bytes, vertices.bytes);
  const ColourImage photograph = io::read_image(image(3));
  const auto difference = [&](const ColourImage& drawn) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        if (!is_background(drawn, x, y)) {
          const std::size_t i = 4 * (std::size_t(y) * kWidth + std::size_t(x));
          sum += std::abs(int(drawn.bytes[i]) - int(photograph.bytes[i]));
          ++count;
        }
    return sum / count;
  };
  EXPECT_LT(difference(textured), difference(vertices)) << "it has the photographs' own pixels";
  fs::remove(path("out/mesh.glb"));
  refuse(1, {"render", out(), "--picture", path("a.png")}, {"mesh.glb"});
}

TEST_F(Render, RefusesReportsThatTellNoCameras) {
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"\"cameras\":", "\"gone\":"},
                                 {"\"focal\":", "\"vocal\":"},
                                 {"{", "["}}) {
    const std::string whole = read_bytes(path("out/report.json"));
    edit(path("out/report.json"), from, to);
    refuse(1, {"render", out(), "--picture", path("a.png")}, {"report.json"});
    write_bytes(path("out/report.json"), whole);
  }
  EXPECT_FALSE(fs::exists(path("a.png")));
}

TEST_F(Render, CtrlCLeavesNothingOfTheFilm) {
  RunOptions options;
  options.signal = SIGINT;
  options.signal_after = " film\n";
  options.signal_delay_seconds = 0.3;
  const Finished run = run_photohull(
      {"render", out(), "--turntable", path("turn"), "--frames", "3600", "--size", "640x480"},
      options);
  EXPECT_EQ(run.code, 130);
  EXPECT_FALSE(fs::exists(path("turn")));
}

}  // namespace
}  // namespace photohull::test

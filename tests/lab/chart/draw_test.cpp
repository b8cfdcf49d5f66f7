#include "lab/chart/draw.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <regex>

#include "core/error.h"
#include "example_outcomes.h"
#include "io/image_file.h"
#include "lab/chart/chart_set.h"
#include "lab/chart/embedded_files.h"
#include "lab/chart/page.h"
#include "lab/chart/png.h"
#include "lab/chart/svg_renderer.h"
#include "support/scratch_folder.h"

namespace photohull::chart {
namespace {

namespace fs = std::filesystem;
using test::example_outcomes;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> draw(const std::vector<Outcome>& outcomes, const fs::path& folder) {
  Plan plan;
  plan.title = "Ball & <cube>";
  plan.scenes = {{"ball", "", false}, {"cube", "", false}};
  fs::create_directories(folder);
  Progress silent;
  return draw_charts(plan, outcomes, folder, silent);
}

/// The example's charts, drawn once for all tests.
class Draw : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<ScratchFolder>();
    files_ = draw(example_outcomes(), *folder_ / "out");
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static fs::path file(const std::string& name) { return *folder_ / "out" / name; }
  static std::string text(const std::string& name) { return read_text(file(name)); }

  static inline std::unique_ptr<ScratchFolder> folder_;
  static inline std::vector<std::string> files_;
};

TEST_F(Draw, WritesThePageAndEveryChartTwice) {
  EXPECT_EQ(files_.size(), 1u + 2 * 15);
  EXPECT_EQ(files_[0], "index.html");
  for (const std::string& name : files_) EXPECT_GT(fs::file_size(file(name)), 1000u);
}

TEST_F(Draw, SvgIsWellFormedAndHasTheLabels) {
  for (const std::string& name : files_) {
    if (!name.ends_with(".svg")) continue;
    // librsvg refuses what is not XML.
    write_png(text(name), 100, 60, *folder_ / "check.png");
  }
  const std::string svg = text("speed-accuracy--ball.svg");
  for (const std::string label : {"hull 50", "hull 100", "hull 200", "carving 200", "peer",
                                  "carving 100 failed", "Pareto front", "90 %"})
    EXPECT_THAT(svg, HasSubstr(">" + label + "</text>")) << label;
  EXPECT_THAT(svg, Not(HasSubstr("dominant-baseline")));
  EXPECT_THAT(text("accuracy-resolution--ball.svg"), HasSubstr("hull: error ∝ N^−1.00"));
  EXPECT_THAT(text("stages--ball.svg"), HasSubstr("hull 50 (3 s)"));
}

TEST_F(Draw, PngHasTwiceThePixelsAndInk) {
  const ColourImage image = io::read_image(file("speed-accuracy--ball.png"));
  EXPECT_EQ(image.width, 2000);
  EXPECT_EQ(image.height, 1280);
  std::size_t dark = 0;
  for (std::size_t i = 0; i < image.bytes.size(); i += 4) dark += image.bytes[i] < 128;
  EXPECT_GT(dark, 2000u);
  EXPECT_EQ(image.bytes[0], 255) << "the page is white";
}

TEST_F(Draw, PageNeedsNothingElse) {
  std::string page = text("index.html");
  // Its own elements and script; ECharts has texts that look like elements.
  const std::size_t library = page.find(echarts_js());
  ASSERT_NE(library, std::string::npos);
  page.erase(library, echarts_js().size());
  const std::regex loads(
      R"(<(script|link|img|iframe|object|embed|source)\b[^>]*\b(src|href|data)\s*=)");
  EXPECT_FALSE(std::regex_search(page, loads));
  const std::regex remote(R"((src|href|action)\s*=\s*["']?(https?:)?//)");
  EXPECT_FALSE(std::regex_search(page, remote));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_THAT(page, HasSubstr("setOption"));
  EXPECT_THAT(page, Not(HasSubstr("@@")));
}

TEST_F(Draw, PageEscapesWhatOthersWrote) {
  std::string page = text("index.html");
  EXPECT_THAT(page, HasSubstr("<title>Ball &amp; &lt;cube&gt;</title>"));
  EXPECT_THAT(page, HasSubstr("FAILED: reconstruct: exit code 1: &lt;b&gt;out &amp; about"));
  EXPECT_THAT(page, Not(HasSubstr("<b>out")));
}

TEST_F(Draw, RemovesChartsOfEarlierDrawingsAndRepeatsTheOthers) {
  const fs::path again = *folder_ / "again";
  auto fewer = example_outcomes();
  std::erase_if(fewer, [](const Outcome& o) { return o.scene == "cube"; });
  draw(fewer, again);
  const std::string svg = read_text(again / "speed-accuracy--ball.svg");
  EXPECT_EQ(svg, text("speed-accuracy--ball.svg")) << "equal outcomes give equal files";
  EXPECT_TRUE(fs::exists(again / "stages--ball.svg"));
  for (Outcome& o : fewer) o.stages.clear();
  EXPECT_THAT(draw(fewer, again), Not(Contains("stages--ball.svg")));
  EXPECT_FALSE(fs::exists(again / "stages--ball.svg"));
  EXPECT_TRUE(fs::exists(again / "speed-accuracy--ball.svg"));
}

TEST(SvgRenderer, SaysWhatIsWrongWithAnOption) {
  SvgRenderer renderer;
  EXPECT_THROW(renderer.render({{"xAxis", {{"type", "no such axis"}}},
                                {"yAxis", Json::object()},
                                {"series", {{{"type", "line"}, {"data", {1, 2}}}}}},
                               400, 300),
               Error);
  const std::string svg = renderer.render({{"title", {{"text", "still < alive"}}}}, 400, 300);
  EXPECT_THAT(svg, HasSubstr("still &lt; alive"));
}

TEST(WritePng, RefusesWhatIsNoSvg) {
  const ScratchFolder folder;
  EXPECT_THROW(write_png("<svg><unclosed", 10, 10, folder / "a.png"), Error);
  EXPECT_FALSE(fs::exists(folder / "a.png"));
}

}  // namespace
}  // namespace photohull::chart

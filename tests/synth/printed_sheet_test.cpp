// Sheets under synthesized objects, by the detector that photographs of real ones are given to.
#include "synth/printed_sheet.h"

#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "calib/find_tags.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "sheet/bend_sheet.h"
#include "support/scratch_folder.h"
#include "synth/degrade_image.h"
#include "synth/synthesize.h"

namespace photohull::synth {
namespace {

using testing::HasSubstr;

struct Made {
  Scene scene;
  Sheet sheet;
  glm::dvec3 origin;
  double unit = 1;
};

/// A small pawn on a sheet, photographed twice from above; `more` goes into the spec's sheet.
Made make(const ScratchFolder& folder, const std::string& more) {
  Made made;
  made.sheet = make_sheet({});
  write_atomically(folder / "board.json", sheet_text(made.sheet));
  const std::string text = R"({"geometry": {"shape": "pawn"}, "truth_samples": 500,
    "image": {"width": 640, "height": 480, "samples": 4, "maps": false},
    "cameras": {"rings": [{"count": 2, "elevation": 55}], "distance": 4, "fill": 0.4},
    "sheet": {"board": "board.json")" +
                           more + "}}";
  Progress silent;
  synthesize(parse_spec(text, "spec", folder / ""), folder / "scene", silent);
  made.scene = io::load_scene((folder / "scene").string(), {});
  std::ifstream file(folder / "scene" / "spec.json");
  const auto sheet = nlohmann::json::parse(file)["result"]["sheet"];
  for (int i = 0; i < 3; ++i) made.origin[i] = sheet["origin"][std::size_t(i)];
  made.unit = sheet["unit"];
  return made;
}

/// Pixels between where tags' corners are found and where they are, the largest; and how many tags
/// are seen in both views.
std::pair<double, int> compare(const Made& made, const glm::dvec3& bend, double print) {
  double off = 0;
  int tags = 0;
  for (const SourceView& source : made.scene.views) {
    const SheetView view = find_tags(io::read_image(source.image), made.sheet, source.name);
    tags += int(view.tags.size());
    for (std::size_t i = 0; i < view.board.points.size(); ++i) {
      glm::dvec3 place = view.board.points[i];
      bend_sheet(&bend.x, 0.5 * glm::length(made.sheet.page), &place.x);
      const auto pixel = source.camera.project(made.origin + made.unit * print * place);
      off = std::max(off, glm::length(*pixel - view.board.pixels[i]));
    }
  }
  return {off, tags};
}

TEST(PrintedSheet, TagsAreSeenWhereTheCameraHasThem) {
  const ScratchFolder folder;
  const Made made = make(folder, "");
  const auto [off, tags] = compare(made, glm::dvec3(0.0), 1);
  EXPECT_LT(off, 0.25);
  EXPECT_GE(tags, 36);
  // The object stands on it, within the free space.
  const glm::dvec3 low = (made.scene.box->min - made.origin) / made.unit,
                   high = (made.scene.box->max - made.origin) / made.unit;
  EXPECT_GT(low.x, made.sheet.free_min.x);
  EXPECT_LT(high.y, made.sheet.free_max.y);
  EXPECT_NEAR(low.z, 0, 0.05 * (high.z - low.z));
}

TEST(PrintedSheet, IsBentAndScaledAsTheSpecSays) {
  const ScratchFolder folder;
  const Made made = make(folder, R"(, "bend": [0, 2, 9], "print": 0.97)");
  EXPECT_LT(compare(made, {0, 2, 9}, 0.97).first, 0.25);
  EXPECT_GT(compare(made, {0, 0, 0}, 0.97).first, 1);
  EXPECT_GT(compare(made, {0, 2, 9}, 1).first, 1);
}

TEST(PrintedSheet, HidesAShareOfTheTags) {
  const ScratchFolder folder;
  const auto [off, tags] = compare(make(folder, R"(, "hidden": 0.5)"), glm::dvec3(0.0), 1);
  EXPECT_LT(off, 0.25);  // what is left is not the worse for it
  EXPECT_GE(tags, 16);
  EXPECT_LE(tags, 28);
}

TEST(PrintedSheet, IsRefusedWhereItHidesTheObject) {
  const ScratchFolder folder;
  write_atomically(folder / "board.json", sheet_text(make_sheet({})));
  const std::string text =
      R"({"sheet": {"board": "board.json"}, "cameras": {"rings": [{"count": 2, "elevation": -30}]}})";
  Progress silent;
  try {
    synthesize(parse_spec(text, "spec", folder / ""), folder / "scene", silent);
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("below the sheet"));
  }
}

TEST(DegradeImage, EdgesBlurTheMoreTheFartherFromTheMiddle) {
  constexpr int kWide = 101;
  std::vector<glm::vec3> image(std::size_t(kWide) * kWide, glm::vec3(0));
  const auto at = [&](int x, int y) -> glm::vec3& { return image[std::size_t(y) * kWide + x]; };
  for (const int place : {50, 70, 90}) at(place, place) = glm::vec3(1);
  blur_edges(image, kWide, kWide, 2);
  EXPECT_FLOAT_EQ(at(50, 50).x, 1);
  EXPECT_LT(at(70, 70).x, 0.95f);
  EXPECT_LT(at(90, 90).x, 0.4f * at(70, 70).x);
}

}  // namespace
}  // namespace photohull::synth

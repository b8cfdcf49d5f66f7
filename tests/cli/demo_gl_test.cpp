// The demo, from the checkout and from a folder that has no photographs.
#include <gmock/gmock.h>

#include <filesystem>

#include "sphere_scene.h"
#include "support/places.h"

namespace photohull::test {
namespace {

using testing::HasSubstr;

class Demo : public SphereScene {};

TEST_F(Demo, ReconstructsThePhotographsThatComeWithTheProgram) {
  const std::string text = succeed({"demo", "--out", path("out"), "--resolution", "32"}).out;
  EXPECT_THAT(text, HasSubstr("photohull reconstruct "));
  EXPECT_THAT(text, HasSubstr("/templeSparseRing --out " + path("out")));
  EXPECT_THAT(text, HasSubstr("16 views, "));
  EXPECT_TRUE(std::filesystem::is_regular_file(path("out/report.html")));
}

TEST_F(Demo, SaysWhereItsPhotographsAreMissing) {
  const std::filesystem::path program = path("bin/photohull-main");
  std::filesystem::create_directories(program.parent_path());
  std::filesystem::copy_file(
      std::filesystem::path(test::program()).parent_path() / "photohull-main", program);
  const Finished done = run_program({program.string(), "demo", "--out", out()});
  EXPECT_EQ(done.code, 1);
  EXPECT_THAT(done.err, HasSubstr(path("share/photohull/templeSparseRing") +
                                  ": the photographs of the demo are not there"));
  EXPECT_FALSE(std::filesystem::exists(out()));
}

TEST_F(Demo, WantsAFolder) { fail(2, {"demo", "--out", ""}, {"--out is empty"}); }

}  // namespace
}  // namespace photohull::test

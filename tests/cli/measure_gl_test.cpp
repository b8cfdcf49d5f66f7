// Results measured.
#include <cmath>
#include <nlohmann/json.hpp>

#include "reconstruct_fixture.h"
#include "support/places.h"

namespace photohull::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class Measure : public Reconstruct {
 protected:
  Arguments quick() const { return reconstruct({"--method", "hull", "--report-page", "off"}); }
};

TEST_F(Measure, TheBallHasItsSizes) {
  succeed(quick());
  const auto m =
      nlohmann::json::parse(succeed({"measure", out(), "--sections", "9", "--json"}).out);
  const double volume = m.at("volume").at("value");
  EXPECT_NEAR(volume, kSphereVolume, 0.15 * kSphereVolume);
  EXPECT_GT(m.at("volume").at("uncertainty"), 0);
  const std::vector<double> low = m.at("box").at("min"), high = m.at("box").at("max");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(low[axis], kCentre[int(axis)] - kRadius, 0.15);
    EXPECT_NEAR(high[axis], kCentre[int(axis)] + kRadius, 0.15);
  }
  ASSERT_EQ(m.at("sections").size(), 9u);
  const double middle = m.at("sections")[4].at("area").at("value");
  EXPECT_NEAR(middle, std::acos(-1.0) * kRadius * kRadius, 0.2);
  EXPECT_GE(m.at("hull_volume").at("value"), volume);
}

TEST_F(Measure, TextAndTable) {
  succeed(quick());
  EXPECT_THAT(succeed({"measure", out()}).out, HasSubstr("\nheight  "));
  const std::string table = succeed({"measure", out(), out(), "--csv"}).out;
  EXPECT_THAT(table, StartsWith("name,volume,volume_uncertainty,area,"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 3);
}

TEST_F(Measure, SaysWhatIsWrong) {
  succeed(quick());
  const auto refuse = [&](int code, Arguments words, const std::string& sentence) {
    words.insert(words.begin(), {test::program(), "measure"});
    const Finished run = run_program(words);
    EXPECT_EQ(run.code, code) << run.err;
    EXPECT_THAT(run.err, HasSubstr(sentence));
  };
  refuse(2, {out(), "--axis", "w"}, "--axis w: expected one of up, x, y, z");
  refuse(2, {out(), "--sections", "-1"}, "--sections -1");
  refuse(2, {out(), out(), "--json"}, "--json is for one folder");
  refuse(2, {out(), "--json", "--csv"}, "exclude each other");
  refuse(2, {""}, "DIR is empty");
  refuse(1, {path("images")}, "report.json");
}

}  // namespace
}  // namespace photohull::test

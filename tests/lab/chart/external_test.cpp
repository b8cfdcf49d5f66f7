#include "lab/chart/external.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fake_program.h"

namespace photohull::chart {
namespace {

using test::error_of;
using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Optional;
using testing::Pair;

class ReadExternal : public testing::Test {
 protected:
  std::vector<Outcome> read(const std::string& name, const std::string& text) {
    write_text(folder_ / name, text);
    return read_external(folder_ / name);
  }
  std::string fault(const std::string& name, const std::string& text) {
    return error_of([&] { read(name, text); });
  }
  ScratchFolder folder_;
};

TEST_F(ReadExternal, JsonWithMissingColumns) {
  const auto rows = read("peers.json", R"([
      {"scene": "bunny", "tool": "mve", "cpu_s": 147, "wall_s": 77, "peak_mb": 58, "f01": 88.5,
       "f025": 95.9, "f1": 99, "acc90_pct": 0.117, "comp05": 98.7, "triangles": 52047},
      {"scene": "fandisk", "tool": "mve", "cpu_s": null, "failed": true}])");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_TRUE(rows[0].external);
  EXPECT_EQ(rows[0].label(), "mve");
  EXPECT_THAT(rows[0].cpu_seconds, Optional(147.0));
  EXPECT_THAT(rows[0].figures.f_percent,
              ElementsAre(Pair(DoubleEq(0.1), 88.5), Pair(DoubleEq(0.25), 95.9), Pair(1.0, 99.0)));
  EXPECT_THAT(rows[0].figures.accuracy_percent, Optional(0.117));
  EXPECT_EQ(rows[0].figures.triangles, 52047);
  EXPECT_FALSE(rows[1].cpu_seconds);
  EXPECT_TRUE(rows[1].failed);
}

TEST_F(ReadExternal, CsvWithQuotesAndEmptyFields) {
  const auto rows = read("peers.csv",
                         "\xef\xbb\xbfscene,tool,cpu_s,f025,resolution\r\n"
                         "bunny,\"mve, \"\"full\"\"\",478,98.42,\r\n"
                         "bunny,open3d,,17.97,256\r\n\r\n");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].variant, "mve, \"full\"");
  EXPECT_THAT(rows[0].cpu_seconds, Optional(478.0));
  EXPECT_THAT(rows[0].figures.f_at(0.25), Optional(98.42));
  EXPECT_FALSE(rows[1].cpu_seconds);
  EXPECT_EQ(rows[1].label(), "open3d 256");
}

TEST_F(ReadExternal, FaultsNameFileRowAndColumn) {
  EXPECT_THAT(fault("a.csv", "scene,tool,cpu_s\nbunny,mve,fast\n"),
              testing::AllOf(HasSubstr("a.csv"), HasSubstr("row 1.cpu_s"), HasSubstr("\"fast\"")));
  EXPECT_THAT(fault("a.csv", "scene,tool,cpu_s\nbunny,mve\n"), HasSubstr("row 1 has 2 fields"));
  EXPECT_THAT(fault("a.csv", "scene,tool\nbunny,\"mve\n"), HasSubstr("not closed"));
  EXPECT_THAT(fault("a.csv", ""), HasSubstr("header"));
  EXPECT_THAT(fault("a.csv", "scene,tool,cpu_sec\nbunny,mve,1\n"),
              HasSubstr("did you mean 'cpu_s'"));
  EXPECT_THAT(fault("a.json", R"([{"scene": "a", "tool": "b", "f025": 120}])"),
              HasSubstr("[0].f025: expected a number from 0 to 100, found 120"));
  EXPECT_THAT(fault("a.json", R"([{"scene": "a"}])"), HasSubstr("[0].tool: is missing"));
  EXPECT_THAT(fault("a.json", R"({"scene": "a"})"), HasSubstr("expected an array"));
  EXPECT_THAT(fault("a.json", R"([{"scene": "a", "tool": "b"}, {"scene": "a", "tool": "b"}])"),
              HasSubstr("[1]: b on a is there twice"));
}

}  // namespace
}  // namespace photohull::chart

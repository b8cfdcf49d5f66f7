// Every way to go wrong that ways_to_go_wrong.json lists: the exit code and the sentence, which
// docs/measurements/ways_to_go_wrong.md shows. PHOTOHULL_WRITE_WAYS=1 writes that document anew.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>

#include "sphere_scene.h"
#include "support/places.h"
#include "ways.h"

namespace photohull::test {

/// For GoogleTest's messages.
void PrintTo(const Way& way, std::ostream* out) { *out << way.title; }

namespace {

using testing::AnyOf;
using testing::StartsWith;

const std::string kDocument = test::in_checkout("docs/measurements/ways_to_go_wrong.md");
constexpr std::size_t kLeastWays = 60;

/// What was told in each way that this process has tried, by title.
std::map<std::string, std::vector<std::string>>& tried() {
  static std::map<std::string, std::vector<std::string>> all;
  return all;
}

std::string as_json(const Heard& heard) {
  return nlohmann::json({{"code", heard.code}, {"says", heard.says}, {"prints", heard.prints}})
      .dump(1);
}

class WaysToGoWrong : public testing::TestWithParam<Way> {};

TEST_P(WaysToGoWrong, AreAnsweredAsTold) {
  const Way& way = GetParam();
  const Heard heard = try_way(way);
  if (!heard.possible) GTEST_SKIP() << "this machine cannot arrange it: " << way.with;
  SCOPED_TRACE(way.title + "\nheard " + as_json(heard));
  EXPECT_EQ(heard.code, way.code);
  for (std::size_t i = 0; i < way.says.size(); ++i) {
    ASSERT_LT(i, heard.says.size()) << "expected: " << way.says[i];
    EXPECT_TRUE(fits(way.says[i], heard.says[i])) << "expected: " << way.says[i];
  }
  if (way.says.empty()) {
    EXPECT_THAT(heard.says, testing::IsEmpty());
  }
  // Nothing of what libraries say, and a sentence wherever the program did not succeed.
  for (const std::string& line : heard.says)
    EXPECT_THAT(line,
                AnyOf(StartsWith("photohull: "), StartsWith("warning: "), StartsWith("note: ")));
  if (way.code != 0) {
    ASSERT_FALSE(heard.says.empty());
    EXPECT_THAT(heard.says.back(), StartsWith("photohull: "));
  }
  const std::vector<std::string> lines = told(way, heard);
  EXPECT_EQ(lines.size(), way.says.size() + way.prints.size()) << "on standard output";
  tried()[way.title] = lines;
}

/// A test's name, such as "Masks_12".
std::string test_name(const testing::TestParamInfo<Way>& info) {
  std::string name = info.param.group.substr(0, info.param.group.find_first_of(" ,")) + "_" +
                     std::to_string(info.index);
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, WaysToGoWrong, testing::ValuesIn(read_ways()), test_name);

bool writes_document() { return std::getenv("PHOTOHULL_WRITE_WAYS") != nullptr; }

TEST(WaysToGoWrongDocument, ShowsEveryWayAndNoOther) {
  if (writes_document()) GTEST_SKIP() << "the document is being written";
  const std::vector<Way> ways = read_ways();
  EXPECT_GE(ways.size(), kLeastWays);
  std::vector<std::string> rows;
  std::istringstream in(read_bytes(kDocument));
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("| ") && !line.starts_with("| what went wrong")) rows.push_back(line);
  ASSERT_EQ(rows.size(), ways.size());
  for (std::size_t i = 0; i < ways.size(); ++i) {
    std::vector<std::string> patterns = ways[i].says;
    patterns.insert(patterns.end(), ways[i].prints.begin(), ways[i].prints.end());
    EXPECT_TRUE(fits(document_row(ways[i], patterns), rows[i]))
        << "expected " << document_row(ways[i], patterns) << "\nfound " << rows[i];
  }
}

TEST(WaysToGoWrongDocument, TitlesDiffer) {
  std::set<std::string> titles;
  for (const Way& way : read_ways()) EXPECT_TRUE(titles.insert(way.title).second) << way.title;
}

/// Writes the document's tables when all ways have been tried; what stands before them stays.
class DocumentWriter : public testing::Environment {
 public:
  void TearDown() override {
    if (!writes_document()) return;
    const std::vector<Way> ways = read_ways();
    std::vector<std::vector<std::string>> lines;
    for (const Way& way : ways) {
      if (!tried().contains(way.title)) {
        ADD_FAILURE() << "the document is written by a run of all ways; not tried: " << way.title;
        return;
      }
      lines.push_back(tried()[way.title]);
    }
    const std::string before = read_bytes(kDocument);
    const std::string head = before.substr(0, before.find("\n## "));
    write_bytes(kDocument, head + document_tables(ways, lines));
  }
};

const auto* const kWriter = testing::AddGlobalTestEnvironment(new DocumentWriter);

}  // namespace
}  // namespace photohull::test

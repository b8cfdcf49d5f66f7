#include "core/describe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace photohull {
namespace {

using testing::ElementsAre;

struct Lists {
  std::vector<double> distances = {0.5, 2};
  std::vector<std::uint64_t> seeds;
  std::vector<std::string> names = {"all"};
  std::uint64_t seed = 1;
};

void describe(Described& to, Lists& lists) {
  to.list("distances", &lists.distances, above(0, 10), "distances up to 10", "");
  to.list("seeds", &lists.seeds, at_least(0), "whole numbers", "");
  to.list("names", &lists.names, {}, "names", "");
  to.number("seed", &lists.seed, at_least(0), "", "");
}

class DescribedLists : public testing::Test {
 protected:
  DescribedLists() { describe(described_, lists_); }
  const Option& option(const char* name) const { return *described_.find(name); }
  std::string refusal(const char* name, const std::string& text) const {
    try {
      read_option(option(name), text);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  }
  Lists lists_;
  Described described_;
};

TEST_F(DescribedLists, ReplaceTheirDefaults) {
  EXPECT_EQ(text_of(option("distances")), "0.5,2");
  EXPECT_EQ(text_of(option("seeds")), "");
  read_option(option("distances"), "1,0.25,3e0");
  read_option(option("seeds"), "18446744073709551615,7");
  read_option(option("names"), "a b,c");
  EXPECT_THAT(lists_.distances, ElementsAre(1, 0.25, 3));
  EXPECT_THAT(lists_.seeds, ElementsAre(18446744073709551615u, 7u));
  EXPECT_THAT(lists_.names, ElementsAre("a b", "c"));
  EXPECT_EQ(text_of(option("seeds")), "18446744073709551615,7");
  EXPECT_EQ(text_of(option("names")), "a b,c");
}

TEST_F(DescribedLists, EachItemMustBeLegal) {
  const std::string legal = "expected distances up to 10, with commas between them";
  EXPECT_EQ(refusal("distances", "1,x"), "distances=x: " + legal);
  EXPECT_EQ(refusal("distances", "1,11"), "distances=1,11: " + legal);
  EXPECT_EQ(refusal("distances", "0"), "distances=0: " + legal);
  EXPECT_EQ(refusal("distances", "1,,2"), "distances=: " + legal);
  EXPECT_EQ(refusal("seeds", "1.5"), "seeds=1.5: expected whole numbers, with commas between them");
  EXPECT_EQ(refusal("seed", "-1"), "seed=-1: expected a whole number");
}

TEST_F(DescribedLists, AreCheckedWhereverTheyComeFrom) {
  EXPECT_NO_THROW(check_options(lists_));
  lists_.distances.push_back(20);
  EXPECT_THAT([&] { check_options(lists_); },
              testing::ThrowsMessage<UsageError>(testing::StartsWith("distances=0.5,2,20: ")));
}

}  // namespace
}  // namespace photohull

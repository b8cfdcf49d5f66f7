// Options that are words or numbers.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "pipeline/reconstruct.h"

namespace photohull::pipeline {
namespace {

TEST(ParseViewsMayMiss, AutoOrANumber) {
  EXPECT_EQ(parse_views_may_miss("auto"), std::nullopt);
  EXPECT_EQ(parse_views_may_miss("0"), 0);
  EXPECT_EQ(parse_views_may_miss("3"), 3);
  EXPECT_EQ(parse_views_may_miss("16"), 16);
}

TEST(ParseViewsMayMiss, AnythingElseIsNamed) {
  for (const std::string bad :
       {"", "-1", "17", "two", "1.5", "3 ", " 3", "+3", "0x2", "99999999999", "Auto", "auto2"}) {
    try {
      parse_views_may_miss(bad);
      ADD_FAILURE() << "'" << bad << "' was taken";
    } catch (const UsageError& e) {
      EXPECT_EQ(std::string(e.what()),
                "--views-may-miss " + bad + ": expected auto, or a number of views from 0 to 16");
    }
  }
}

}  // namespace
}  // namespace photohull::pipeline

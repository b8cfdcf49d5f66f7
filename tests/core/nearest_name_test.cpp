#include "core/nearest_name.h"

#include <gtest/gtest.h>

namespace photohull {
namespace {

TEST(NearestName, IsTheOneWithTheFewestEdits) {
  const std::vector<std::string> names = {"info", "reconstruct", "masks", "--resolution", "--out"};
  EXPECT_EQ(nearest_name("reconstrct", names), "reconstruct");
  EXPECT_EQ(nearest_name("--resolutoin", names), "--resolution");
  EXPECT_EQ(nearest_name("mask", names), "masks");
  EXPECT_EQ(nearest_name("info", names), "info");
}

TEST(NearestName, IsNoneWhereNothingIsNear) {
  EXPECT_EQ(nearest_name("evaluate", {"info", "reconstruct"}), std::nullopt);
  EXPECT_EQ(nearest_name("x", {}), std::nullopt);
  EXPECT_EQ(nearest_name(std::string(1000, 'a'), {std::string(1000, 'a')}), std::nullopt);
}

TEST(NearestName, LongNamesMayDifferByAThird) {
  EXPECT_EQ(nearest_name("refinecameraz", {"refine-cameras"}), "refine-cameras");
  EXPECT_EQ(nearest_name("cat", {"dogs"}), std::nullopt);
}

}  // namespace
}  // namespace photohull

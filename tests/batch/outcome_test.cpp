#include "batch/outcome.h"

#include <gtest/gtest.h>

namespace photohull::batch {
namespace {

Outcome good() {
  return {"1234", "5-6", "scans/a, b", "good", "", 0, 24, 0.5, 1000, 1.5, 2.25, 1 << 20};
}

TEST(Outcome, ComesBackFromItsText) {
  const auto back = outcome_from_json(to_json("a", good()));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->identity, "1234");
  EXPECT_EQ(back->plan, "5-6");
  EXPECT_EQ(back->scene, "scans/a, b");
  EXPECT_TRUE(back->has_result());
  EXPECT_EQ(back->views, 24);
  EXPECT_EQ(back->triangles, 1000);
  EXPECT_EQ(back->cpu_seconds, 2.25);
  EXPECT_EQ(back->peak_memory_bytes, 1 << 20);
}

TEST(Outcome, DamagedTextIsNone) {
  const std::string whole = to_json("a", good());
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(outcome_from_json(whole.substr(0, size))) << size;
  EXPECT_FALSE(outcome_from_json("{}"));
  EXPECT_FALSE(outcome_from_json("[1]"));
}

TEST(Outcome, TableSaysWhatIsKnown) {
  Outcome bad;
  bad.scene = "b";
  bad.exit_code = 1;
  bad.message = "the file \"x\"\nis, sadly, gone";
  const Row rows[] = {{"a", good()}, {"b", bad}, {"c", {}}};
  EXPECT_EQ(table_of(rows),
            "name,scene,verdict,exit_code,views,voxel_size,triangles,wall_seconds,cpu_seconds,"
            "peak_memory_bytes,message\n"
            "a,\"scans/a, b\",good,0,24,0.5,1000,1.5,2.25,1048576,\n"
            "b,b,,1,,,,0,0,0,\"the file \"\"x\"\"\nis, sadly, gone\"\n"
            "c,,,,,,,,,,not made yet\n");
}

}  // namespace
}  // namespace photohull::batch

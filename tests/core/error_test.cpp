#include "core/error.h"

#include <gtest/gtest.h>

#include "core/progress.h"
#include "core/scene.h"

namespace photohull {
namespace {

TEST(Error, TellsItsKind) {
  EXPECT_EQ(Error("x").kind(), ErrorKind::kFailed);
  EXPECT_EQ(UsageError("x").kind(), ErrorKind::kUsage);
  EXPECT_EQ(MemoryError("x").kind(), ErrorKind::kMemory);
  EXPECT_EQ(Cancelled().kind(), ErrorKind::kCancelled);
  EXPECT_STREQ(UsageError("--device: no").what(), "--device: no");
}

TEST(Error, ConcatJoinsValuesOfAllKinds) {
  EXPECT_EQ(concat("view ", 3, ": ", 0.5, ' ', std::string("px")), "view 3: 0.5 px");
}

TEST(CheckDeathTest, PrintsBothOperands) {
  EXPECT_DEATH(PHOTOHULL_CHECK_OP(1 + 1, ==, 3), "1 \\+ 1 == 3 \\(2 vs 3\\)");
  EXPECT_DEATH(PHOTOHULL_CHECK(1 > 2), "check failed: 1 > 2");
}

TEST(Check, EvaluatesItsOperandsOnce) {
  int calls = 0;
  PHOTOHULL_CHECK_OP(++calls, ==, 1);
  PHOTOHULL_CHECK(++calls == 2);
  EXPECT_EQ(calls, 2);
}

TEST(Progress, StopsByTheTokenThatItWasGiven) {
  const CancellationToken token;
  const Progress job(token), other, within(job.token());
  EXPECT_FALSE(job.cancelled());
  token.cancel();
  EXPECT_THROW(job.check_cancelled(), Cancelled);
  EXPECT_THROW(within.check_cancelled(), Cancelled);
  EXPECT_NO_THROW(other.check_cancelled());
  token.reset();
  EXPECT_NO_THROW(job.check_cancelled());
}

TEST(Progress, ThrowsOnceCancellationWasAskedFor) {
  Progress progress;
  process_cancellation().reset();
  EXPECT_NO_THROW(progress.check_cancelled());
  process_cancellation().cancel();
  EXPECT_THROW(progress.check_cancelled(), Cancelled);
  process_cancellation().reset();
  EXPECT_NO_THROW(progress.check_cancelled());
}

TEST(SceneFormat, HasANameOfItsOwn) {
  EXPECT_STREQ(to_string(SceneFormat::kMiddlebury), "middlebury");
  EXPECT_STREQ(to_string(SceneFormat::kColmapText), "colmap-text");
  EXPECT_STREQ(to_string(SceneFormat::kColmapBinary), "colmap-binary");
  EXPECT_STREQ(to_string(SceneFormat::kTransforms), "transforms");
  EXPECT_STREQ(to_string(SceneFormat::kBundler), "bundler");
  EXPECT_STREQ(to_string(SceneFormat::kOpenCv), "opencv");
}

}  // namespace
}  // namespace photohull

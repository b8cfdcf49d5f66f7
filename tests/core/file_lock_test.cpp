#include "core/file_lock.h"

#include <gtest/gtest.h>

#include "support/scratch_folder.h"

namespace photohull {
namespace {

TEST(FileLock, HoldsTheFileWhileItLives) {
  const ScratchFolder folder;
  auto first = FileLock::if_free(folder / "a");
  ASSERT_TRUE(first);
  EXPECT_FALSE(FileLock::if_free(folder / "a"));
  EXPECT_TRUE(FileLock::if_free(folder / "b"));
  first.reset();
  EXPECT_TRUE(FileLock::if_free(folder / "a"));
}

}  // namespace
}  // namespace photohull

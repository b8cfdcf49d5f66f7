#include "gpu/context.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include "core/error.h"
#include "gpu/buffer.h"
#include "gpu/gl.h"
#include "gpu/texture.h"
#include "support/gl_context.h"

namespace photohull::gpu {
namespace {

TEST(Context, OffersWhatTheKernelsNeed) {
  const Context& context = test::gl_context();
  EXPECT_GE(context.limits().ssbo_bytes, 16 << 20);
  EXPECT_GE(context.limits().texture_size, 8192);
  EXPECT_GE(context.limits().texture_layers, 256);
  for (const std::int64_t groups : context.limits().groups) EXPECT_GE(groups, 65535);
  EXPECT_FALSE(context.device().renderer.empty());
  EXPECT_TRUE(context.device().problem.empty());
}

TEST(Context, PendingErrorsAreReportedOnceWithTheirPlace) {
  const Context& context = test::gl_context();
  glEnable(GL_TEXTURE_2D_ARRAY);  // not a capability
  try {
    context.check_errors("the test");
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), ::testing::HasSubstr("the test"));
    EXPECT_THAT(e.what(), ::testing::HasSubstr("invalid enum"));
  }
  EXPECT_NO_THROW(context.check_errors("the test"));
}

TEST(Context, LaunchesAreCountedByName) {
  Context& context = test::gl_context();
  for (int i = 0; i < 3; ++i) Launch launch(context, "counted");
  EXPECT_EQ(context.statistics()["counted"].launches, 3);
  EXPECT_GE(context.statistics()["counted"].seconds, 0);
}

TEST(Context, CountsWhatGoesToTheDeviceAndBack) {
  const Context& context = test::gl_context();
  const Traffic before = context.traffic();
  const Buffer buffer = Buffer::of(std::vector<float>(100));
  EXPECT_EQ(buffer.download<float>(50).size(), 50u);
  TextureArray texture(TextureFormat::kRgba16f, 4, 2, 1);
  texture.upload(0, 4, 2, std::vector<std::uint16_t>(4 * 4 * 2).data());
  const Traffic& after = context.traffic();
  EXPECT_EQ(after.uploads - before.uploads, 2);
  EXPECT_EQ(after.bytes_up - before.bytes_up, 100 * 4 + 4 * 2 * 8);
  EXPECT_EQ(after.downloads - before.downloads, 1);
  EXPECT_EQ(after.bytes_down - before.bytes_down, 50 * 4);
}

std::size_t bytes_in_use() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

// Its mip levels are drawn in many batches, each of which the software rasterizer lets hold it.
TEST(Context, DeletedTexturesAreLetGoOf) {
  Context& context = test::gl_context();
  if (!context.device().software) GTEST_SKIP() << "the device has memory of its own";
  context.release_deleted();
  const std::size_t before = bytes_in_use();
  constexpr std::size_t kBytes = std::size_t(4) * 512 * 512 * 32;
  for (int i = 0; i < 3; ++i) {
    TextureArray texture(TextureFormat::kSrgb8Alpha8, 512, 512, 32, 0);
    texture.generate_mipmaps();
    EXPECT_GT(bytes_in_use(), before + kBytes);
  }
  // Whether small batches overtake the large one is up to the system's scheduler.
  for (int i = 0; i < 3 && bytes_in_use() > before + kBytes / 4; ++i) context.release_deleted();
  EXPECT_LT(bytes_in_use(), before + kBytes / 4);
}

}  // namespace
}  // namespace photohull::gpu

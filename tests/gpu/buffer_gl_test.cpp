#include "gpu/buffer.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>

#include "core/error.h"
#include "support/gl_context.h"

namespace photohull::gpu {
namespace {

class BufferTest : public ::testing::Test {
 protected:
  void TearDown() override { context_.check_errors("buffer test"); }
  Context& context_ = test::gl_context();
};

TEST_F(BufferTest, KeepsWhatItWasMadeFrom) {
  // Shorter than, equal to and longer than the least store of 16 bytes.
  for (const std::size_t count : {1u, 3u, 4u, 5u, 1000u}) {
    std::vector<std::uint32_t> values(count);
    std::iota(values.begin(), values.end(), 7u);
    const Buffer buffer = Buffer::of(values);
    EXPECT_EQ(buffer.bytes(), 4 * count);
    EXPECT_EQ(buffer.download<std::uint32_t>(count), values);
  }
}

TEST_F(BufferTest, LargerThanAStorageBlockIsRefusedWhereAKernelWouldReadIt) {
  Limits low = context_.limits();
  low.ssbo_bytes = 1000;
  const Buffer fits(1000), larger(1001);
  set_current_limits(&low);
  EXPECT_NO_THROW(fits.bind_storage(0));
  EXPECT_THROW(larger.bind_storage(0), Error);
  EXPECT_NO_THROW(larger.bind_uniform(0));
  set_current_limits(&context_.limits());
  EXPECT_NO_THROW(larger.bind_storage(0));
}

TEST_F(BufferTest, WritesAndReadsRanges) {
  Buffer buffer(40);
  buffer.fill(0xffffffffu);
  const std::uint32_t two[2] = {11, 22};
  buffer.write(8, sizeof two, two);
  const std::vector<std::uint32_t> expected{0xffffffffu, 0xffffffffu, 11, 22, 0xffffffffu};
  EXPECT_EQ(buffer.download<std::uint32_t>(5), expected);
  EXPECT_EQ(buffer.download<std::uint32_t>(2, 2), std::vector<std::uint32_t>({11, 22}));
}

TEST_F(BufferTest, FillReachesTheLastWord) {
  Buffer buffer(1000 * 4);
  buffer.fill(5);
  EXPECT_EQ(buffer.download<std::uint32_t>(1000), std::vector<std::uint32_t>(1000, 5));
}

TEST_F(BufferTest, MayBeEmpty) {
  Buffer buffer(0);
  EXPECT_NE(buffer.id(), 0u);
  EXPECT_EQ(buffer.bytes(), 0u);
  buffer.fill(1);
  buffer.write(0, 0, nullptr);
  buffer.bind_storage(0);
  EXPECT_TRUE(buffer.download<int>(0).empty());
  EXPECT_EQ(Buffer::of(std::vector<int>()).bytes(), 0u);
}

TEST_F(BufferTest, AStoreThatIsUsedAgainHoldsWhatTheNextOneWasMadeFrom) {
  const std::vector<std::uint32_t> large(1000, 7), small(900, 9);
  unsigned id = 0;
  {
    const Buffer buffer = Buffer::of(large);
    id = buffer.id();
  }
  Buffer buffer = Buffer::of(small);
  EXPECT_EQ(buffer.id(), id);
  EXPECT_EQ(buffer.bytes(), 3600u);
  EXPECT_EQ(buffer.download<std::uint32_t>(900), small);
  buffer.fill(3);
  EXPECT_EQ(buffer.download<std::uint32_t>(900), std::vector<std::uint32_t>(900, 3));
}

TEST_F(BufferTest, ReadsWhatIsLargerThanWhatIsReadAtOnce) {
  std::vector<std::uint32_t> values(3000001);
  std::iota(values.begin(), values.end(), 1u);
  const Buffer buffer = Buffer::of(values);
  EXPECT_EQ(buffer.download<std::uint32_t>(values.size()), values);
  EXPECT_EQ(buffer.download<std::uint32_t>(2000000, 1000001),
            std::vector<std::uint32_t>(values.begin() + 1000001, values.end()));
}

TEST_F(BufferTest, LargeStoresComeAndGo) {
  for (int i = 0; i < 4; ++i) {
    std::vector<Buffer> buffers;
    for (std::uint32_t k = 0; k < 6; ++k)
      buffers.push_back(Buffer::of(std::vector<std::uint32_t>((k + 1) << 20, k)));
    for (std::uint32_t k = 0; k < 6; ++k)
      EXPECT_EQ(buffers[k].download<std::uint32_t>(1, k << 20).front(), k);
  }
}

TEST_F(BufferTest, MovesItsHandle) {
  Buffer a = Buffer::of(std::vector<int>{1, 2, 3, 4});
  const unsigned id = a.id();
  Buffer b = std::move(a);
  EXPECT_EQ(b.id(), id);
  Buffer c;
  c = std::move(b);
  EXPECT_EQ(c.id(), id);
  EXPECT_EQ(c.download<int>(4), std::vector<int>({1, 2, 3, 4}));
}

TEST_F(BufferTest, AnImpossibleSizeIsAUserError) {
  EXPECT_THROW(Buffer(std::size_t(1) << 60), Error);
}

using BufferDeathTest = BufferTest;

TEST_F(BufferDeathTest, RangesAreChecked) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  Buffer buffer(16);
  int value = 0;
  EXPECT_DEATH(buffer.write(16, 4, &value), "20 vs 16");
  EXPECT_DEATH(buffer.read(0, 20, &value), "20 vs 16");
}

}  // namespace
}  // namespace photohull::gpu

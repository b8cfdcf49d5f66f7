#include "gpu/limits.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace photohull::gpu {
namespace {

const Limits kDevice{1 << 27, 16384, 2048, {65535, 65535, 65535}};

TEST(Limits, AreLoweredByNameAndNeverRaised) {
  const Limits low = lowered(kDevice, "groups=7,block=1000,size=64,layers=3");
  EXPECT_EQ(low.groups, (std::array<std::int64_t, 3>{7, 7, 7}));
  EXPECT_EQ(low.ssbo_bytes, 1000);
  EXPECT_EQ(low.texture_size, 64);
  EXPECT_EQ(low.texture_layers, 3);
  const Limits same = lowered(kDevice, "groups=9999999,block=99999999999,size=99999,layers=99999");
  EXPECT_EQ(same.groups, kDevice.groups);
  EXPECT_EQ(same.ssbo_bytes, kDevice.ssbo_bytes);
  EXPECT_EQ(same.texture_size, kDevice.texture_size);
  EXPECT_EQ(same.texture_layers, kDevice.texture_layers);
  EXPECT_EQ(lowered(kDevice, "").groups, kDevice.groups);
}

TEST(Limits, RefusesWhatItCannotRead) {
  for (const char* bad : {"groups", "groups=", "groups=0", "groups=-1", "groups=1x", "shaders=3",
                          "groups=1,,size=2", "=3", "99999999999999999999"})
    EXPECT_THROW(lowered(kDevice, bad), UsageError) << bad;
}

TEST(BatchSize, IsWhatAStorageBlockHolds) {
  Limits limits = kDevice;
  limits.ssbo_bytes = 1016;
  set_current_limits(&limits);
  EXPECT_EQ(batch_size(10, 1000), 100u);
  EXPECT_EQ(batch_size(10, 30), 30u);
  EXPECT_EQ(batch_size(10, 1000, 64), 64u);
  EXPECT_EQ(batch_size(10, 1000, 1, 516), 50u);
  EXPECT_EQ(batch_size(5000, 1000), 1u);  // one item: its buffer tells that it is too large
  set_current_limits(nullptr);
}

}  // namespace
}  // namespace photohull::gpu

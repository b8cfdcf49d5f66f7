// choose_device on made-up machines.
#include "gpu/device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace photohull::gpu {
namespace {

using ::testing::HasSubstr;

DeviceInfo device(int index, bool software, const std::string& problem = "") {
  return {index, software ? "llvmpipe" : "A GPU", "vendor", "4.5", software, problem};
}

std::string message_of(const std::vector<DeviceInfo>& devices, const std::string& selection) {
  try {
    choose_device(devices, selection);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(ChooseDevice, AutoPrefersHardwareWhateverTheOrder) {
  EXPECT_EQ(choose_device({device(0, true), device(1, false)}, "auto").index, 1);
  EXPECT_EQ(choose_device({device(0, false), device(1, true)}, "auto").index, 0);
}

TEST(ChooseDevice, AutoTakesTheFirstOfSeveral) {
  EXPECT_EQ(choose_device({device(0, false), device(1, false)}, "auto").index, 0);
}

TEST(ChooseDevice, AutoPassesOverDevicesWithAProblem) {
  EXPECT_EQ(choose_device({device(0, false, "no driver"), device(1, true)}, "auto").index, 1);
}

TEST(ChooseDevice, SoftwareNeverMeansHardware) {
  EXPECT_EQ(choose_device({device(0, false), device(1, true)}, "software").index, 1);
  EXPECT_THAT(message_of({device(0, false)}, "software"), HasSubstr("libgl1-mesa-dri"));
}

TEST(ChooseDevice, NoUsableDeviceIsAFailureNotAUsageError) {
  try {
    choose_device({device(0, false, "no permission")}, "auto");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::kFailed);
  }
  EXPECT_THROW(choose_device({}, "auto"), Error);
}

TEST(ChooseDevice, AnIndexMeansEglsNumber) {
  EXPECT_EQ(choose_device({device(0, false), device(1, true)}, "1").index, 1);
  EXPECT_THAT(message_of({device(0, false, "no permission")}, "0"), HasSubstr("no permission"));
}

TEST(ChooseDevice, BadTextAndBadIndicesAreUsageErrors) {
  const std::vector<DeviceInfo> devices{device(0, false), device(1, true)};
  for (const char* text : {"", "gpu", "1x", " 1", "0x1", "1.0", "99999999999999999999", "Auto"})
    EXPECT_THROW(choose_device(devices, text), UsageError) << "'" << text << "'";
  for (const char* text : {"2", "-1", "2147483647"})
    EXPECT_THROW(choose_device(devices, text), UsageError) << text;
  EXPECT_THAT(message_of(devices, "2"), HasSubstr("0 to 1"));
  EXPECT_THAT(message_of(devices, "gpu"), HasSubstr("'gpu'"));
}

}  // namespace
}  // namespace photohull::gpu

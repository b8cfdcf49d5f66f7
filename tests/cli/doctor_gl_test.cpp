// What the program tells of the machine.
#include <gmock/gmock.h>

#include "sphere_scene.h"

namespace photohull::test {
namespace {

using testing::HasSubstr;

class Doctor : public SphereScene {};

TEST_F(Doctor, TellsOfTheMachineAndTestsIt) {
  const std::string text = succeed({"doctor", "--device", "software"}).out;
  for (const char* line : {"photohull   ", "commit ", "libraries   ", "OpenVDB ", "system      ",
                           "Linux ", "processor   ", "memory      ", "device 0 ",
                           "takes       device ", "self-test   passed in "})
    EXPECT_THAT(text, HasSubstr(line));
}

TEST_F(Doctor, NamesVariablesThatChangeTheDevice) {
  RunOptions options;
  options.environment = {"LP_NUM_THREADS=1"};
  EXPECT_THAT(succeed({"doctor"}, options).out, HasSubstr("variable    LP_NUM_THREADS=1\n"));
}

TEST_F(Doctor, RefusesDevicesThatThereAreNot) {
  fail(2, {"doctor", "--device", "99"}, {"--device 99", "photohull devices"});
}

}  // namespace
}  // namespace photohull::test

#include "gpu/debug_messages.h"

#include <gmock/gmock.h>

#include <cstdlib>

#include "gpu/context.h"
#include "gpu/gl.h"
#include "support/gl_context.h"

namespace photohull::gpu {
namespace {

std::string said_by_a_wrong_call(const char* variable) {
  const int device = test::gl_context().device().index;
  if (variable) setenv(variable, "1", 1);
  testing::internal::CaptureStderr();
  {
    const Context context(device);
    glEnable(0xFFFF);
    EXPECT_EQ(glGetError(), GLenum(GL_INVALID_ENUM));
  }
  if (variable) unsetenv(variable);
  return testing::internal::GetCapturedStderr();
}

TEST(DebugMessages, AreWhatTheDriverSaysOfWrongCallsWhereTheyAreAskedFor) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  // In a process of its own, for a context of this one is current to other tests.
  EXPECT_EXIT(
      {
        const std::string asked = said_by_a_wrong_call(kDebugVariable);
        const std::string unasked = said_by_a_wrong_call(nullptr);
        const bool right = asked.find("OpenGL: ") != std::string::npos && unasked.empty();
        std::exit(right ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace photohull::gpu

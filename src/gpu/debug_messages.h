// What the driver says of the calls that it gets (KHR_debug). Internal to gpu.
#pragma once

namespace photohull::gpu {

/// The environment variable that has drivers' messages printed to standard error, one a line that
/// begins with "OpenGL: ". Notifications, which are no complaints, are left out.
inline constexpr const char* kDebugVariable = "PHOTOHULL_GL_DEBUG";

bool debug_is_asked_for();
/// Of the context that is current, which was made as one for debugging.
void print_debug_messages();

}  // namespace photohull::gpu

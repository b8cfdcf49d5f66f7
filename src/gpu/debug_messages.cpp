#include "gpu/debug_messages.h"

#include <cstdio>
#include <cstdlib>

#include "gpu/gl.h"

namespace photohull::gpu {
namespace {

void APIENTRY print(GLenum, GLenum, GLuint, GLenum severity, GLsizei length, const GLchar* text,
                    const void*) {
  if (severity != GL_DEBUG_SEVERITY_NOTIFICATION)
    std::fprintf(stderr, "OpenGL: %.*s\n", int(length), text);
}

}  // namespace

bool debug_is_asked_for() { return std::getenv(kDebugVariable) != nullptr; }

void print_debug_messages() {
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(print, nullptr);
  glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_TRUE);
}

}  // namespace photohull::gpu

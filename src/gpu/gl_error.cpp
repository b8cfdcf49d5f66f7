#include "gpu/gl_error.h"

#include "core/option_word.h"
#include "gpu/gl.h"

namespace photohull::gpu {
namespace {

const char* name_of(unsigned error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "invalid enum";
    case GL_INVALID_VALUE:
      return "invalid value";
    case GL_INVALID_OPERATION:
      return "invalid operation";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "invalid framebuffer operation";
    default:
      return "unknown error";
  }
}

}  // namespace

unsigned pending_error() {
  const unsigned error = glGetError();
  if (error != GL_NO_ERROR) return error;
  return glGetGraphicsResetStatus() == GL_NO_ERROR ? GL_NO_ERROR : GL_CONTEXT_LOST;
}

void throw_gl_error(unsigned error, const std::string& what, const std::string& mend) {
  if (error == GL_OUT_OF_MEMORY)
    throw Error(concat("the graphics device is out of memory at ", what, "; ", mend,
                       ", or give another ", option_word("device")),
                ErrorKind::kDevice);
  if (error == GL_CONTEXT_LOST)
    throw Error(concat("the graphics device was lost at ", what,
                       ": its driver was reset, or it was removed; run the same command again, or "
                       "give another ",
                       option_word("device")),
                ErrorKind::kDevice);
  throw Error(concat("OpenGL failed at ", what, ": ", name_of(error), "; give another ",
                     option_word("device"), ", such as software"));
}

void check_gl(const std::string& what) {
  const unsigned error = pending_error();
  if (error != GL_NO_ERROR) throw_gl_error(error, what);
}

}  // namespace photohull::gpu

// Private to module gpu: what OpenGL reports, as errors for people.
#pragma once

#include <string>

#include "core/error.h"
#include "core/option_word.h"

namespace photohull::gpu {

/// The error that OpenGL has pending, which this clears; GL_CONTEXT_LOST where the device was reset
/// or removed; GL_NO_ERROR.
unsigned pending_error();

/// Throws Error, for a lost context and for memory of the kind kDevice. `what` says what failed,
/// as in "a buffer of 12 MiB"; `mend` what takes less memory.
[[noreturn]] void throw_gl_error(unsigned error, const std::string& what,
                                 const std::string& mend = concat("lower ",
                                                                  option_word("resolution")));

/// Throws for an error that is pending.
void check_gl(const std::string& what);

}  // namespace photohull::gpu

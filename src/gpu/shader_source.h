// Shaders embedded in the program, and their #include directives resolved.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace photohull::gpu {

struct EmbeddedShader {
  std::string_view path;  ///< relative to shaders/
  std::string_view text;
};

/// Generated at build time from shaders/.
std::span<const EmbeddedShader> embedded_shaders();

/// Text of the named entry point with "#version 450", `defines` and all its includes expanded once;
/// #line directives number the files in the order of `shader_files`. Lines of include_instead among
/// the defines replace includes.
std::string expand_shader(std::string_view path, std::string_view defines);

/// Name of the file that a #line number of expand_shader stands for.
std::string shader_file(int number);

/// A line that defines `prefix` with a lower-case name in upper case and underscores after it.
std::string define(std::string_view prefix, std::string_view name);

/// A line, a comment to compilers, that makes shaders include the embedded file `other` where they
/// include `file`.
std::string include_instead(std::string_view file, std::string_view other);

}  // namespace photohull::gpu

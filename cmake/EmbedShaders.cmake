# Writes OUT: a C++ file that holds every shader as a raw string literal, keyed by its path under
# shaders/. Called at build time: cmake -DROOT=... -DOUT=... -P EmbedShaders.cmake
file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/*.glsl ${ROOT}/*.h)
list(SORT files)
set(text "#include \"gpu/shader_source.h\"\n\nnamespace photohull::gpu {\n\n")
string(APPEND text "std::span<const EmbeddedShader> embedded_shaders() {\n")
string(APPEND text "  static constexpr EmbeddedShader kShaders[] = {\n")
foreach(file ${files})
  file(READ ${ROOT}/${file} content)
  string(APPEND text "      {\"${file}\", R\"glsl(${content})glsl\"},\n")
endforeach()
string(APPEND text "  };\n  return kShaders;\n}\n\n}  // namespace photohull::gpu\n")
file(WRITE ${OUT} "${text}")

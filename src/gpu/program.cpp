#include "gpu/program.h"

#include <algorithm>
#include <regex>
#include <vector>

#include "core/error.h"
#include "gpu/context.h"
#include "gpu/gl.h"
#include "gpu/program_resources.h"
#include "gpu/shader_source.h"

namespace photohull::gpu {
namespace {

/// Compiler logs say "3:27(5): error"; the first number is a #line file number.
std::string name_files(const std::string& log) {
  static const std::regex position("(^|\\n)([0-9]+)([:(][0-9]+)");
  std::string out;
  auto rest = log.cbegin();
  for (std::sregex_iterator it(log.begin(), log.end(), position), end; it != end; ++it) {
    out.append(rest, (*it)[0].first);
    out += (*it)[1].str() + "shaders/" + shader_file(std::stoi((*it)[2])) + (*it)[3].str();
    rest = (*it)[0].second;
  }
  out.append(rest, log.cend());
  return out;
}

unsigned compile_stage(GLenum stage, std::string_view path, std::string_view defines) {
  const std::string source = expand_shader(path, defines);
  const char* text = source.c_str();
  const GLuint shader = glCreateShader(stage);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint ok = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok) return shader;
  GLint length = 0;
  glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string log(std::size_t(length), '\0');
  glGetShaderInfoLog(shader, length, nullptr, log.data());
  glDeleteShader(shader);
  throw Error(concat("shaders/", path, " does not compile on this device:\n", name_files(log)));
}

unsigned link(std::initializer_list<unsigned> shaders, std::string_view name) {
  const GLuint program = glCreateProgram();
  for (const unsigned shader : shaders) glAttachShader(program, shader);
  glLinkProgram(program);
  for (const unsigned shader : shaders) glDeleteShader(shader);
  GLint ok = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok) {
    // This device may have more: others need not.
    const std::string beyond = beyond_promise(resources_of(program));
    if (beyond.empty()) return program;
    glDeleteProgram(program);
    throw Error(concat("shaders/", name, " takes more than OpenGL 4.5 promises: ", beyond));
  }
  GLint length = 0;
  glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
  std::string log(std::size_t(length), '\0');
  glGetProgramInfoLog(program, length, nullptr, log.data());
  glDeleteProgram(program);
  throw Error(concat("shaders/", name, " does not link on this device:\n", log));
}

}  // namespace

std::shared_ptr<const Program> Program::compute(Context& context, std::string_view path,
                                                std::string_view defines) {
  auto& kept = context.programs()[concat(path, "\n", defines)];
  if (!kept)
    kept = std::make_shared<const Program>(
        Program(link({compile_stage(GL_COMPUTE_SHADER, path, defines)}, path)));
  return kept;
}

std::shared_ptr<const Program> Program::raster(Context& context, std::string_view vertex_path,
                                               std::string_view fragment_path,
                                               std::string_view defines) {
  auto& kept = context.programs()[concat(vertex_path, "\n", fragment_path, "\n", defines)];
  if (!kept) {
    const unsigned vertex = compile_stage(GL_VERTEX_SHADER, vertex_path, defines);
    const unsigned fragment = compile_stage(GL_FRAGMENT_SHADER, fragment_path, defines);
    kept = std::make_shared<const Program>(Program(link({vertex, fragment}, fragment_path)));
  }
  return kept;
}

Program::~Program() {
  if (id_) glDeleteProgram(id_);
}

Program::Program(unsigned id) : id_(id), first_group_(glGetUniformLocation(id, "first_group")) {}

void Program::use() const { glUseProgram(id_); }

int Program::location(const char* name) const {
  const int at = glGetUniformLocation(id_, name);
  if (at < 0) check_failed("uniform", 0, name);
  return at;
}

void Program::set(const char* n, int v) const { glProgramUniform1i(id_, location(n), v); }
void Program::set(const char* n, unsigned v) const { glProgramUniform1ui(id_, location(n), v); }
void Program::set(const char* n, float v) const { glProgramUniform1f(id_, location(n), v); }
void Program::set(const char* n, const glm::ivec2& v) const {
  glProgramUniform2iv(id_, location(n), 1, &v[0]);
}
void Program::set(const char* n, const glm::ivec3& v) const {
  glProgramUniform3iv(id_, location(n), 1, &v[0]);
}
void Program::set(const char* n, const glm::ivec4& v) const {
  glProgramUniform4iv(id_, location(n), 1, &v[0]);
}
void Program::set(const char* n, const glm::vec2& v) const {
  glProgramUniform2fv(id_, location(n), 1, &v[0]);
}
void Program::set(const char* n, const glm::vec3& v) const {
  glProgramUniform3fv(id_, location(n), 1, &v[0]);
}
void Program::set(const char* n, const glm::vec4& v) const {
  glProgramUniform4fv(id_, location(n), 1, &v[0]);
}
void Program::set(const char* n, const glm::mat4& v) const {
  glProgramUniformMatrix4fv(id_, location(n), 1, GL_FALSE, &v[0][0]);
}

void Program::dispatch(Context& context, const char* name, std::size_t groups_x,
                       std::size_t groups_y, std::size_t groups_z) const {
  if (groups_x == 0 || groups_y == 0 || groups_z == 0) return;
  use();
  {
    Launch launch(context, name);
    const auto& [most_x, most_y, most_z] = context.limits().groups;
    for (std::size_t z = 0; z < groups_z; z += std::size_t(most_z))
      for (std::size_t y = 0; y < groups_y; y += std::size_t(most_y))
        for (std::size_t x = 0; x < groups_x; x += std::size_t(most_x)) {
          glProgramUniform3ui(id_, first_group_, unsigned(x), unsigned(y), unsigned(z));
          glDispatchCompute(unsigned(std::min(groups_x - x, std::size_t(most_x))),
                            unsigned(std::min(groups_y - y, std::size_t(most_y))),
                            unsigned(std::min(groups_z - z, std::size_t(most_z))));
        }
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
  }
  context.statistics()[name].groups += std::int64_t(groups_x * groups_y * groups_z);
  context.check_errors(name);
}

}  // namespace photohull::gpu

#include "support/filtering.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "gpu/buffer.h"
#include "gpu/gl.h"
#include "support/gl_context.h"

namespace photohull::test {
namespace {

constexpr int kPlaces = 1 << 14;  // many more than the weights that hardware tells apart

/// Looks a texture of two texels up at kPlaces places from the middle of one to that of the other.
constexpr const char* kShader = R"(#version 450 core
layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler2D pair;
layout(std430, binding = 0) writeonly buffer Found { float found[]; };
void main() {
  float place = float(gl_GlobalInvocationID.x) / float(1 << 14);
  found[gl_GlobalInvocationID.x] = textureLod(pair, vec2((0.5 + place) / 2.0, 0.5), 0.0).r;
})";

std::vector<float> look_up() {
  const GLuint program = glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &kShader);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  PHOTOHULL_CHECK(linked);
  GLuint texture = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &texture);
  glTextureStorage2D(texture, 1, GL_R32F, 2, 1);
  const float texels[2] = {0, 1};
  glTextureSubImage2D(texture, 0, 0, 0, 2, 1, GL_RED, GL_FLOAT, texels);
  glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(texture, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  const gpu::Buffer found(kPlaces * sizeof(float));
  glUseProgram(program);
  glBindTextureUnit(0, texture);
  glBindSampler(0, 0);
  found.bind_storage(0);
  glDispatchCompute(kPlaces / 64, 1, 1);
  std::vector<float> values = found.download<float>(kPlaces);
  glUseProgram(0);
  glDeleteTextures(1, &texture);
  glDeleteProgram(program);
  return values;
}

double measure() {
  gl_context();
  const std::vector<float> found = look_up();
  double worst = 0;
  for (int i = 0; i < kPlaces; ++i)
    worst = std::max(worst, std::abs(double(found[std::size_t(i)]) - i / double(kPlaces)));
  return worst;
}

}  // namespace

double filtering_error() {
  static const double error = measure();
  return error;
}

}  // namespace photohull::test

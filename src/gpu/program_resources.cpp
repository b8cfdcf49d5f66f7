#include "gpu/program_resources.h"

#include <algorithm>
#include <vector>

#include "core/error.h"
#include "gpu/gl.h"

namespace photohull::gpu {
namespace {

constexpr int kTextures = 16, kImages = 8;  // of a shader
constexpr int kStorageBlocks = 8, kStorageBindings = 8;
constexpr int kImageUnits = 8, kTextureUnits = 96;
constexpr int kUniformComponents = 1024, kUniformBlockBytes = 16384;
constexpr std::array<int, 3> kGroup{1024, 1024, 64};
constexpr int kGroupInvocations = 1024;

int count_of(unsigned program, GLenum interface) {
  GLint count = 0;
  glGetProgramInterfaceiv(program, interface, GL_ACTIVE_RESOURCES, &count);
  return count;
}

int property(unsigned program, GLenum interface, int index, GLenum name) {
  GLint value = 0;
  glGetProgramResourceiv(program, interface, GLuint(index), 1, &name, 1, nullptr, &value);
  return value;
}

bool is_image(int type) {
  return type >= GL_IMAGE_1D && type <= GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY;
}

bool is_texture(int type) {
  return (type >= GL_SAMPLER_1D && type <= GL_SAMPLER_2D_RECT_SHADOW) ||
         (type >= GL_SAMPLER_1D_ARRAY && type <= GL_SAMPLER_CUBE_SHADOW) ||
         (type >= GL_INT_SAMPLER_1D && type <= GL_UNSIGNED_INT_SAMPLER_BUFFER) ||
         (type >= GL_SAMPLER_CUBE_MAP_ARRAY && type <= GL_UNSIGNED_INT_SAMPLER_CUBE_MAP_ARRAY) ||
         (type >= GL_SAMPLER_2D_MULTISAMPLE &&
          type <= GL_UNSIGNED_INT_SAMPLER_2D_MULTISAMPLE_ARRAY);
}

int components(int type) {
  switch (type) {
    case GL_FLOAT_VEC2:
    case GL_INT_VEC2:
    case GL_UNSIGNED_INT_VEC2:
      return 2;
    case GL_FLOAT_VEC3:
    case GL_INT_VEC3:
    case GL_UNSIGNED_INT_VEC3:
      return 3;
    case GL_FLOAT_VEC4:
    case GL_INT_VEC4:
    case GL_UNSIGNED_INT_VEC4:
      return 4;
    case GL_FLOAT_MAT3:
      return 9;
    case GL_FLOAT_MAT4:
      return 16;
    default:
      return 1;
  }
}

/// Calls visit(stage) for each shader that the resource is referenced by. Of compute programs that
/// is the only one: Mesa's query misses most storage blocks.
template <typename Visit>
void for_each_stage(unsigned program, GLenum interface, int index, ProgramResources& r,
                    const Visit& visit) {
  if (r.is_compute) {
    visit(r.compute);
    return;
  }
  if (property(program, interface, index, GL_REFERENCED_BY_VERTEX_SHADER)) visit(r.vertex);
  if (property(program, interface, index, GL_REFERENCED_BY_FRAGMENT_SHADER)) visit(r.fragment);
}

bool has_compute_shader(unsigned program) {
  GLint shaders = 0;
  glGetProgramiv(program, GL_ATTACHED_SHADERS, &shaders);
  std::vector<GLuint> names(std::size_t(std::max(shaders, 1)), 0);
  glGetAttachedShaders(program, shaders, nullptr, names.data());
  return std::any_of(names.begin(), names.begin() + shaders, [](GLuint name) {
    GLint type = 0;
    glGetShaderiv(name, GL_SHADER_TYPE, &type);
    return type == GL_COMPUTE_SHADER;
  });
}

void add_uniform(unsigned program, int index, ProgramResources& r) {
  const int type = property(program, GL_UNIFORM, index, GL_TYPE);
  const int elements = std::max(1, property(program, GL_UNIFORM, index, GL_ARRAY_SIZE));
  if (!is_image(type) && !is_texture(type)) {
    if (property(program, GL_UNIFORM, index, GL_BLOCK_INDEX) < 0)
      r.uniform_components += elements * components(type);
    return;
  }
  GLint unit = 0;
  glGetUniformiv(program, property(program, GL_UNIFORM, index, GL_LOCATION), &unit);
  int& highest = is_image(type) ? r.highest_image_unit : r.highest_texture_unit;
  highest = std::max(highest, unit + elements - 1);
  for_each_stage(program, GL_UNIFORM, index, r, [&](ProgramResources::Stage& stage) {
    (is_image(type) ? stage.images : stage.textures) += elements;
  });
}

}  // namespace

ProgramResources resources_of(unsigned program) {
  ProgramResources r;
  r.is_compute = has_compute_shader(program);
  if (r.is_compute) glGetProgramiv(program, GL_COMPUTE_WORK_GROUP_SIZE, r.group.data());
  for (int i = 0; i < count_of(program, GL_SHADER_STORAGE_BLOCK); ++i) {
    r.highest_storage_binding =
        std::max(r.highest_storage_binding,
                 property(program, GL_SHADER_STORAGE_BLOCK, i, GL_BUFFER_BINDING));
    for_each_stage(program, GL_SHADER_STORAGE_BLOCK, i, r,
                   [](ProgramResources::Stage& stage) { ++stage.storage_blocks; });
  }
  for (int i = 0; i < count_of(program, GL_UNIFORM_BLOCK); ++i)
    r.uniform_block_bytes = std::max(r.uniform_block_bytes,
                                     property(program, GL_UNIFORM_BLOCK, i, GL_BUFFER_DATA_SIZE));
  for (int i = 0; i < count_of(program, GL_UNIFORM); ++i) add_uniform(program, i, r);
  return r;
}

std::string beyond_promise(const ProgramResources& r) {
  std::string found;
  const auto look = [&](int taken, int promised, const char* what) {
    if (taken > promised)
      found += concat(found.empty() ? "" : ", ", taken, ' ', what, " (at most ", promised, ")");
  };
  look(r.compute.storage_blocks, kStorageBlocks, "storage blocks in a compute shader");
  look(r.fragment.storage_blocks, kStorageBlocks, "storage blocks in a fragment shader");
  look(r.vertex.storage_blocks, 0, "storage blocks in a vertex shader");
  look(r.compute.textures, kTextures, "textures in a compute shader");
  look(r.fragment.textures, kTextures, "textures in a fragment shader");
  look(r.vertex.textures, kTextures, "textures in a vertex shader");
  look(r.compute.images, kImages, "images in a compute shader");
  look(r.fragment.images, kImages, "images in a fragment shader");
  look(r.vertex.images, 0, "images in a vertex shader");
  look(r.highest_storage_binding + 1, kStorageBindings, "bindings of storage blocks");
  look(r.highest_image_unit + 1, kImageUnits, "image units");
  look(r.highest_texture_unit + 1, kTextureUnits, "texture units");
  look(r.uniform_components, kUniformComponents, "numbers in uniforms");
  look(r.uniform_block_bytes, kUniformBlockBytes, "bytes in a uniform block");
  look(r.group[0], kGroup[0], "invocations of a group along x");
  look(r.group[1], kGroup[1], "invocations of a group along y");
  look(r.group[2], kGroup[2], "invocations of a group along z");
  look(r.group[0] * r.group[1] * r.group[2], kGroupInvocations, "invocations of a group");
  return found;
}

}  // namespace photohull::gpu

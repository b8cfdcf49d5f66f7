// What a program takes of the device, against what OpenGL 4.5 promises. Internal to gpu.
#pragma once

#include <array>
#include <string>

namespace photohull::gpu {

/// Of the compute shader, or of vertex and fragment shader: of each what it uses.
struct ProgramResources {
  struct Stage {
    int storage_blocks = 0, textures = 0, images = 0;
  };
  bool is_compute = false;
  Stage compute, vertex, fragment;
  int highest_storage_binding = -1, highest_image_unit = -1, highest_texture_unit = -1;
  int uniform_components = 0;         ///< of uniforms outside blocks, all shaders together
  int uniform_block_bytes = 0;        ///< the largest block
  std::array<int, 3> group{1, 1, 1};  ///< invocations of a work group along x, y and z
};

/// Of a linked program of the current context.
ProgramResources resources_of(unsigned program);

/// What goes beyond the minimum of the implementation-dependent values of the OpenGL 4.5 core
/// specification (its tables 23.53 to 23.70), so that some device may not have it; empty: nothing.
/// Storage blocks are the exception: the specification promises 8 bindings and 8 blocks of a
/// shader, and the sweeps' kernels take 10 blocks and 14 bindings; 16 are allowed here.
std::string beyond_promise(const ProgramResources& resources);

}  // namespace photohull::gpu

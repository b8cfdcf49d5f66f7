#version 450 core
#extension GL_GOOGLE_include_directive : require
// A mesh for render::Rasterizer. With TEXTURED its colours are on pages.
layout(location = 0) in vec3 position;  // relative to the mesh's origin
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 colour;    // sRGB-encoded; with TEXTURED xy: place on the page, z: page
layout(location = 0) out vec3 camera_normal;
layout(location = 1) out vec3 vertex_colour;
layout(location = 2) out vec3 mesh_position;
layout(location = 3) out vec3 mesh_normal;
layout(location = 0) uniform mat4 clip_from_mesh;
layout(location = 1) uniform mat4 camera_from_mesh;  // rotation only

void main() {
  gl_Position = clip_from_mesh * vec4(position, 1.0);
  camera_normal = mat3(camera_from_mesh) * normal;
  vertex_colour = colour.rgb;
  mesh_position = position;
  mesh_normal = normal;
}

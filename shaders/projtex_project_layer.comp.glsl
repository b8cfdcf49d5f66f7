#version 450 core
#extension GL_GOOGLE_include_directive : require
// Projective texture mapping onto a reference plane: for every selected brick of a layer and each of
// its views, the image as seen on the plane, one value a voxel, with an apron of kPatchRadius voxels.
// Trilinear mip-mapping, lambda from the longest edge of the voxel's footprint, and n x n
// supersampling [Montenegro03, 3.4.2]. Values are square roots of linear light, which makes the noise
// even; alpha < 0 marks what the image does not show.
// x: selected brick; y: view slot. Reference: projtex::reference::project_point.
#include "include/projection.glsl"
#include "include/layer.glsl"

layout(local_size_x = 48) in;
layout(std430, binding = 5) readonly buffer Selected { uint selected_count; uint pad0, pad1, pad2; uvec4 selected[]; };
layout(std430, binding = 6) writeonly buffer Samples { vec4 samples[]; };
layout(binding = 0) uniform sampler2DArray images;

void main() {
  uint entry = gl_WorkGroupID.x, slot = gl_WorkGroupID.y;
  uint item = selected[entry + uint(parameters.chunk.x)].x;
  if (int(slot) >= items[item].brick.w) return;
  uint v = items[item].views[slot >> 2u][slot & 3u];
  GpuView view = views[v];

  int n = parameters.layer.y;
  float plane = float(parameters.layer.x) - 0.5 * float(parameters.layer.w);
  vec2 origin = vec2(item_origin(item) - kPatchRadius);
  vec3 base = project(view, layer_point(origin, plane));
  vec3 du = project(view, layer_point(origin + vec2(1.0, 0.0), plane)) - base;
  vec3 dv = project(view, layer_point(origin + vec2(0.0, 1.0), plane)) - base;

  for (int i = int(gl_LocalInvocationID.x); i < kApronArea; i += 48) {
    vec3 centre = base + du * float(i % kApronEdge) + dv * float(i / kApronEdge);
    vec2 pixel = centre.xy / centre.z;
    vec4 sum = vec4(0.0, 0.0, 0.0, -1.0);
    if (centre.z > 0.0 && on_image(view, pixel)) {
      // Jacobian of (s/q, t/q): footprint edges in pixels.
      vec2 edge_u = (du.xy - pixel * du.z) / centre.z, edge_v = (dv.xy - pixel * dv.z) / centre.z;
      float longest = sqrt(max(dot(edge_u, edge_u), dot(edge_v, edge_v)));
      float lod = log2(max(longest / float(n), 1.0));
      sum = vec4(0.0);
      for (int b = 0; b < n; ++b)
        for (int a = 0; a < n; ++a) {
          vec2 offset = (vec2(float(a), float(b)) + 0.5) / float(n) - 0.5;
          vec3 p = centre + du * offset.x + dv * offset.y;
          sum += textureLod(images, vec3(texture_coordinate(view, p.xy / p.z), float(v)), lod);
        }
      sum /= float(n * n);
      sum = vec4(sqrt(max(sum.rgb, 0.0)), sum.a);
    }
    samples[(entry * uint(kMaxLayerViews) + slot) * uint(kApronArea) + uint(i)] = sum;
  }
}

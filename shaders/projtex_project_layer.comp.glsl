#version 450 core
#extension GL_GOOGLE_include_directive : require
// Projective texture mapping onto a reference plane: for every selected brick of a layer and each of
// its views, the image as seen on the plane, one value a voxel, with an apron of kPatchRadius voxels.
// Mip-mapped, lambda from the longest edge of the voxel's footprint, and n x n supersampling
// [Montenegro03, 3.4.2]. Values are square roots of linear light, which makes the noise even;
// alpha < 0 marks what the image does not show.
// One work group a selected brick and search offset, eight threads a view: on software devices a vector of threads
// shares the view's set-up. Reference: projtex::reference::project_layer_sample.
#include "include/dispatch.glsl"
#include "include/projection.glsl"
#include "include/layer_items.glsl"
#include "include/search_disc.glsl"

#ifndef SUPERSAMPLE
#define SUPERSAMPLE 1  // n: n x n samples a voxel
#endif

layout(local_size_x = 8, local_size_y = kMaxLayerViews) in;
layout(std430, binding = kSweepSelectedBinding) readonly buffer Selected { uint selected_count; uint pad0, pad1, pad2; uvec4 selected[]; };
layout(std430, binding = kSweepSamplesBinding) writeonly buffer Samples { vec4 samples[]; };
layout(binding = kImagesUnit) uniform sampler2DArray images;

void main() {
  uint entry = work_group().x, slot = gl_LocalInvocationID.y;
  uint item = selected[entry + uint(parameters.chunk.x)].x;
  uint v = items[item].views[slot >> 2u][slot & 3u];
  uint search = work_group().y;
  GpuView view = shifted(views[v], kSearchOffsets[search]);

  const int n = SUPERSAMPLE;
  float plane = float(parameters.layer.x) - 0.5 * float(parameters.layer.w);
  vec2 origin = vec2(item_origin(item) - kPatchRadius);
  vec3 base = project(view, layer_point(origin, plane));
  vec3 du = project(view, layer_point(origin + vec2(1.0, 0.0), plane)) - base;
  vec3 dv = project(view, layer_point(origin + vec2(0.0, 1.0), plane)) - base;
  // Lambda from the Jacobian of (s/q, t/q) at the middle of the apron: it changes little over a brick.
  vec3 middle = base + (du + dv) * (0.5 * float(kApronEdge - 1));
  vec2 edge_u = (du.xy - middle.xy / middle.z * du.z) / middle.z;
  vec2 edge_v = (dv.xy - middle.xy / middle.z * dv.z) / middle.z;
  float longest = sqrt(max(dot(edge_u, edge_u), dot(edge_v, edge_v))) / float(n);
  float lod = middle.z > 0.0 ? log2(max(longest, 1.0)) : 0.0;

  // Pixels to normalised texture coordinates.
  vec4 scale = vec4(view.size.zw, 0.5 * view.size.zw);
  uint target = ((entry * uint(kMaxLayerViews) + slot) * uint(SEARCH_TAPS) + search) * uint(kApronArea);
  int end = int(slot) < items[item].brick.w ? kApronArea : 0;

  for (int i = int(gl_LocalInvocationID.x); i < end; i += 8) {
    vec3 centre = base + du * float(i % kApronEdge) + dv * float(i / kApronEdge);
    vec2 pixel = centre.xy / centre.z;
    bool shown = centre.z > 0.0 && on_image(view, pixel);
#if SUPERSAMPLE > 1
    vec4 sum = vec4(0.0);
    for (int k = 0; k < n * n; ++k) {
      vec2 offset = (vec2(float(k % n), float(k / n)) + 0.5) / float(n) - 0.5;
      vec3 p = centre + du * offset.x + dv * offset.y;
      sum += textureLod(images, vec3(p.xy / p.z * scale.xy + scale.zw, float(v)), lod);
    }
    sum /= float(n * n);
#else
    vec4 sum = textureLod(images, vec3(pixel * scale.xy + scale.zw, float(v)), lod);
#endif
    samples[target + uint(i)] =
        shown ? vec4(sqrt(max(sum.rgb, 0.0)), sum.a) : vec4(0.0, 0.0, 0.0, -1.0);
  }
}

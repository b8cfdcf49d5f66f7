#version 450 core
#extension GL_GOOGLE_include_directive : require
// As projtex_project_layer, with the sampler that SAMPLER_... chooses: a footprint for every sample,
// images weighted by their coverage. Alpha < 0 marks what the image does not show, 0 what it shows as
// background. SAMPLER_CENTROID takes the voxel's centre whatever the plane, as carving in image space
// does. One work group a selected brick and search offset, eight threads a view.
// Reference: projtex::reference::sample_square.
#include "include/dispatch.glsl"
#include "include/sample_image.glsl"
#include "include/layer_items.glsl"
#include "include/search_disc.glsl"

layout(local_size_x = 8, local_size_y = kMaxLayerViews) in;
layout(std430, binding = kSweepSelectedBinding) readonly buffer Selected { uint selected_count; uint pad0, pad1, pad2; uvec4 selected[]; };
layout(std430, binding = kSweepSamplesBinding) writeonly buffer Samples { vec4 samples[]; };

void main() {
  uint entry = work_group().x, slot = gl_LocalInvocationID.y;
  uint item = selected[entry + uint(parameters.chunk.x)].x;
  uint v = items[item].views[slot >> 2u][slot & 3u];
  uint search = work_group().y;
  GpuView view = shifted(views[v], kSearchOffsets[search]);
#ifdef SAMPLER_CENTROID
  float plane = float(parameters.layer.x);
#else
  float plane = float(parameters.layer.x) - 0.5 * float(parameters.layer.w);
#endif
  vec2 origin = vec2(item_origin(item) - kPatchRadius);
  vec3 corner = layer_point(origin, plane), base = project(view, corner);
  vec3 by_u = project_step(view, layer_point(origin + vec2(1.0, 0.0), plane) - corner);
  vec3 by_v = project_step(view, layer_point(origin + vec2(0.0, 1.0), plane) - corner);
  uint target = ((entry * uint(kMaxLayerViews) + slot) * uint(SEARCH_TAPS) + search) * uint(kApronArea);
  int end = int(slot) < items[item].brick.w ? kApronArea : 0;
  for (int i = int(gl_LocalInvocationID.x); i < end; i += 8) {
    vec3 at = base + by_u * float(i % kApronEdge) + by_v * float(i / kApronEdge);
    vec4 covered = sample_square(view, v, at, by_u, by_v);
    bool shown = at.z > 0.0 && on_image(view, at.xy / at.z);
    samples[target + uint(i)] = covered.a >= kLeastCoverage ? resolve(covered)
                                                            : vec4(0.0, 0.0, 0.0, shown ? 0.0 : -1.0);
  }
}

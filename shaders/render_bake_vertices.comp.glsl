#version 450 core
#extension GL_GOOGLE_include_directive : require
// Colour of mesh vertices from the photographs that see them best, and how well these agree; the
// formulas are in render/bake_colour.h and render/confidence.h. One thread a vertex; a work group
// looks at the views of its list only, which costs software rasterizers half as much as looking at
// all. Reference: render::reference::bake_vertex.
#include "include/dispatch.glsl"
#include "include/projection.glsl"
#include "include/depth_map.glsl"
#include "shared/bake.h"

layout(local_size_x = 64) in;  // kListedPoints
layout(std140, binding = kBakeParametersBinding) uniform Parameters { BakeParameters parameters; };
layout(std430, binding = kBakeVerticesBinding) readonly buffer Vertices { SurfacePoint vertices[]; };
layout(std430, binding = kBakeResultsBinding) writeonly buffer Baked { BakeResult baked[]; };
layout(std430, binding = kBakeViewListsBinding) readonly buffer ViewLists { uint view_lists[]; };  // render::list_views
layout(binding = kImagesUnit) uniform sampler2DArray images;

// The best views in falling order of weight; 0 where there are fewer.
float best_weight[kMaxBakeViews];
int best_view[kMaxBakeViews];
vec3 direction_sum;
float direction_count;

void insert(int view, float weight) {
  for (int k = 0; k < kMaxBakeViews; ++k) {
    bool better = weight > best_weight[k];
    float other_weight = better ? best_weight[k] : weight;
    int other_view = better ? best_view[k] : view;
    best_weight[k] = better ? weight : best_weight[k];
    best_view[k] = better ? view : best_view[k];
    weight = other_weight;
    view = other_view;
  }
}

void choose_views(vec3 position, vec3 normal) {
  for (int k = 0; k < kMaxBakeViews; ++k) best_weight[k] = 0.0;
  for (int k = 0; k < kMaxBakeViews; ++k) best_view[k] = 0;
  direction_sum = vec3(0.0);
  direction_count = 0.0;
  vec3 receiver = position + kBakeShift * normal;
  uint list = work_group().x * uint(parameters.counts.y + 1);
  uint listed = view_lists[list];
  for (uint k = 1u; k <= listed; ++k) {
    int v = int(view_lists[list + k]);
    GpuView view = views[v];
    vec3 to_camera = view.centre.xyz - position;
    float reciprocal = inversesqrt(dot(to_camera, to_camera));
    float cosine = dot(to_camera, normal) * reciprocal;
    if (!(cosine > kBakeMinCosine)) continue;
    vec3 p = project(view, receiver);
    vec2 pixel = p.xy / p.z;
    if (p.z <= 1.0 || !on_image(view, pixel)) continue;
    if (!visible(uint(v), pixel, p.z, kBakeDepthBias)) continue;
    direction_sum += to_camera * reciprocal;
    direction_count += 1.0;
    float density = view.centre.w / p.z;
    float sharp = view.detail.x * view.detail.x;
    sharp *= sharp;
    insert(v, cosine * cosine * cosine * density * density * sharp * sharp);
  }
}

// Colours of the chosen views in linear light, and their fine detail in square roots; views that
// know nothing there lose their weight.
void fetch(vec3 position, out vec3 colours[kMaxBakeViews], out vec3 details[kMaxBakeViews]) {
  for (int k = 0; k < kMaxBakeViews; ++k) {
    GpuView view = views[best_view[k]];
    vec3 p = project(view, position);
    vec2 pixel = p.xy / p.z;
    float level = floor(max(log2(view.centre.w / p.z), 0.0) + 0.5);
    vec3 coordinate = vec3(texture_coordinate(view, pixel), float(best_view[k]));
    vec4 texel = textureLod(images, coordinate, level);
    vec3 around = textureLod(images, coordinate, level + float(kBakeDetailLevels)).rgb;
    bool known = p.z > 0.0 && on_image(view, pixel) && texel.a >= kBakeMinAlpha;
    best_weight[k] = known ? best_weight[k] : 0.0;
    colours[k] = known ? max(texel.rgb, 0.0) : vec3(0.0);
    details[k] = known ? sqrt(colours[k]) - sqrt(max(around, 0.0)) : vec3(0.0);
  }
}

// Weighted mean after one step of reweighting about the medoid.
vec3 robust_mean(vec3 colours[kMaxBakeViews], vec3 encoded[kMaxBakeViews], float total) {
  vec3 medoid = encoded[0];
  float least = 1e30;
  for (int i = 0; i < kMaxBakeViews; ++i) {
    float cost = 0.0;
    for (int j = 0; j < kMaxBakeViews; ++j)
      cost += best_weight[j] * distance(encoded[i], encoded[j]);
    bool better = best_weight[i] > 0.0 && cost < least;
    medoid = better ? encoded[i] : medoid;
    least = better ? cost : least;
  }
  float scale = 2.0 * parameters.noise.x + least / total;
  vec4 sum = vec4(0.0);
  for (int i = 0; i < kMaxBakeViews; ++i) {
    vec3 d = (encoded[i] - medoid) / scale;
    float inlier = 1.0 / (1.0 + dot(d, d));
    sum += best_weight[i] * inlier * inlier * vec4(colours[i], 1.0);
  }
  return sum.rgb / sum.a;
}

// Weighted mean squared distance from a point.
float spread_about(vec3 centre, vec3 values[kMaxBakeViews], float total) {
  float sum = 0.0;
  for (int i = 0; i < kMaxBakeViews; ++i) {
    vec3 d = values[i] - centre;
    sum += best_weight[i] * dot(d, d);
  }
  return sum / total;
}

void main() {
  uint i = invocation().x;
  if (i >= uint(parameters.counts.x)) return;
  vec3 position = vertices[i].position.xyz;
  choose_views(position, vertices[i].normal.xyz);
  vec3 colours[kMaxBakeViews], details[kMaxBakeViews];
  fetch(position, colours, details);
  float total = 0.0, used = 0.0;
  vec3 encoded[kMaxBakeViews];
  vec3 detail = vec3(0.0);
  for (int k = 0; k < kMaxBakeViews; ++k) {
    total += best_weight[k];
    used += best_weight[k] > 0.0 ? 1.0 : 0.0;
    encoded[k] = sqrt(colours[k]);
    detail += best_weight[k] * details[k];
  }
  if (!(total > 0.0)) {
    baked[i] = BakeResult(vec4(0.0), vec4(0.0), vec4(0.0));
    return;
  }
  vec3 colour = robust_mean(colours, encoded, total);
  float scatter = direction_count - dot(direction_sum, direction_sum) / direction_count;
  baked[i] = BakeResult(
      vec4(colour, used),
      vec4(max(scatter, 0.0), spread_about(sqrt(colour), encoded, total),
           spread_about(detail / total, details, total), spread_about(vec3(0.0), details, total)),
      vec4(direction_count, 0.0, 0.0, 0.0));
}

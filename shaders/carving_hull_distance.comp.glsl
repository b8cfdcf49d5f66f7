#version 450 core
#extension GL_GOOGLE_include_directive : require
// Truncated signed distance to the visual hull for every voxel of a brick: the greatest (or, where
// K silhouettes may leave a point out, the K + 1-th), over the views that see the voxel, of its
// distance to the silhouette, brought from pixels to voxels by
// depth / focal length; or the distance at which the evidence of all views sums to one. One work
// group a brick, one thread a block of 2^3 voxels: a look at the block's centre tells which few views can be the greatest anywhere in it.
// Reference: carving::reference::hull_distance.
#include "include/dispatch.glsl"
#include "include/projection.glsl"
#include "shared/hull.h"

layout(local_size_x = 64) in;
layout(std140, binding = kHullParametersBinding) uniform Parameters { HullParameters parameters; };
layout(std430, binding = kHullBricksBinding) readonly buffer Bricks { ivec4 bricks[]; };  // w: not surely seen
layout(std430, binding = kHullDistancesBinding) writeonly buffer Distances { float distances[]; };
// Where each brick's list of views begins in this buffer (one more for the end), then the lists.
layout(std430, binding = kHullViewListsBinding) readonly buffer Relevant { uint first_and_views[]; };
layout(binding = kBrickSilhouettesUnit) uniform sampler2DArray silhouettes;  // signed pixels, positive outside

const float kNothing = -1e30;
// Voxels by which a view's distance can differ between a block's centre and its voxels: half the
// block's diagonal between voxel centres, 0.87, with room for the perspective.
const float kReach = 1.2;
const int kMaxCandidates = 64;
const int kMaxHeard = 128;  // views beside whose outlines a voxel lies; the rest says nothing
const int kMaxRounds = 16;
const float kSettled = 1e-4;  // voxels

// Distance in voxels that one view gives a point; kNothing where it is not on the image.
float view_distance(int v, GpuView view, vec3 p) {
  vec2 pixel = p.xy / p.z;
  float d = textureLod(silhouettes, vec3(texture_coordinate(view, pixel), float(v)), 0.0).r;
  return p.z > 0.0 && on_image(view, pixel) ? d * p.z / view.centre.w : kNothing;
}

// Near a frame's border the centre of a block can miss the image when its voxels do not.
bool near_border(GpuView view, vec3 p) {
  vec2 pixel = p.xy / p.z;
  float margin = 2.0 * view.centre.w / p.z;
  return p.z < 4.0 || any(lessThan(pixel, vec2(margin))) ||
         any(greaterThan(pixel, view.size.xy - 1.0 - margin));
}

// The K + 1-th greatest distance that the views give a point; kNothing where no more than K see it.
float distance_but_for(int missing, uint first, int relevant_count, vec3 p) {
  float greatest[kMostMissing + 1];
  for (int k = 0; k <= missing; ++k) greatest[k] = kNothing;
  for (int i = 0; i < relevant_count; ++i) {
    int v = int(first_and_views[first + uint(i)]);
    float d = view_distance(v, views[v], project(views[v], p));
    for (int k = 0; k <= missing; ++k) {
      float lesser = min(greatest[k], d);
      greatest[k] = max(greatest[k], d);
      d = lesser;
    }
  }
  return greatest[missing];
}

// Software devices run a masked branch in full, so work is skipped by shorter loops, not by `if`.
void main() {
  uint brick = work_group().x, block = gl_LocalInvocationID.x;
  ivec3 corner = 2 * ivec3(block >> 4u, (block >> 2u) & 3u, block & 3u);
  vec3 base = vec3(bricks[brick].xyz * 8 + corner);
  float band = parameters.pyramid.w;
  uint first = first_and_views[brick], end = first_and_views[brick + 1u];

  float greatest = kNothing, slack = 0.0;
  float centre[kMaxCandidates];
  int relevant_count = int(end - first);
  for (int i = 0; i < relevant_count; ++i) {
    int v = int(first_and_views[first + uint(i)]);
    GpuView view = views[v];
    vec3 p = project(view, base + 0.5);
    float d = near_border(view, p) ? -kNothing : view_distance(v, view, p);
    greatest = d == -kNothing ? greatest : max(greatest, d);
    slack = max(slack, parameters.evidence.x * p.z / view.centre.w);
    centre[min(i, kMaxCandidates - 1)] = i < kMaxCandidates - 1 ? d : -kNothing;
  }
  // Beyond the band the block's centre answers for all of it, unless a frame's border interferes.
  float least = abs(greatest) > band + kReach + slack && greatest != kNothing ? 1e29 : greatest - 2.0 * kReach - slack;
  int candidates[kMaxCandidates];
  int count = 0;
  for (int i = 0; i < min(relevant_count, kMaxCandidates); ++i) {
    candidates[count] = i;
    count += centre[i] >= least ? 1 : 0;
  }

  float value[8];
  for (int i = 0; i < 8; ++i) {
    vec3 p = base + vec3(i >> 2, (i >> 1) & 1, i & 1);
    vec3 beyond = max(parameters.box_min.xyz - p, p - parameters.box_max.xyz);
    value[i] = max(max(beyond.x, max(beyond.y, beyond.z)), least == 1e29 ? greatest : kNothing);
  }
  for (int c = 0; c < count; ++c) {
    // The last candidate stands for all views beyond the list's length.
    int last = candidates[c] == kMaxCandidates - 1 ? relevant_count : candidates[c] + 1;
    for (int i = candidates[c]; i < last; ++i) {
      int v = int(first_and_views[first + uint(i)]);
      GpuView view = views[v];
      for (int j = 0; j < 8; ++j) {
        vec3 p = project(view, base + vec3(j >> 2, (j >> 1) & 1, j & 1));
        value[j] = max(value[j], view_distance(v, view, p) - parameters.evidence.x * p.z / view.centre.w);
      }
    }
  }
  // So much each view says alone. Evidence rises with the distance, so that of all views that of those
  // beyond s is sum((d - s) / full): the s at which it is one, and who is beyond it, settle in some rounds.
  for (int j = 0; j < (parameters.evidence.x > 0.0 && count > 1 ? 8 : 0); ++j) {
    float said[kMaxHeard], slopes[kMaxHeard];
    int heard = 0;
    for (int c = 0; c < count; ++c) {
      int last = candidates[c] == kMaxCandidates - 1 ? relevant_count : candidates[c] + 1;
      for (int i = candidates[c]; i < last; ++i) {
        int v = int(first_and_views[first + uint(i)]);
        GpuView view = views[v];
        vec3 p = project(view, base + vec3(j >> 2, (j >> 1) & 1, j & 1));
        said[heard] = view_distance(v, view, p);
        slopes[heard] = view.centre.w / (parameters.evidence.x * p.z);
        heard = min(heard + (said[heard] > value[j] ? 1 : 0), kMaxHeard - 1);
      }
    }
    float rise = heard > 1 ? 1.0 : 0.0;
    for (int round = 0; round < kMaxRounds && rise > kSettled; ++round) {
      float evidence = -1.0, slope = 1e-6;
      for (int i = 0; i < heard; ++i) {
        float beyond = max(said[i] - value[j], 0.0);
        evidence += beyond * slopes[i];
        slope += beyond > 0.0 ? slopes[i] : 0.0;
      }
      rise = max(evidence / slope, 0.0);
      value[j] += rise;
    }
  }
  int missing = parameters.limits.x;
  for (int j = 0; j < (missing > 0 ? 8 : 0); ++j) {
    vec3 p = base + vec3(j >> 2, (j >> 1) & 1, j & 1);
    vec3 beyond = max(parameters.box_min.xyz - p, p - parameters.box_max.xyz);
    value[j] = max(max(beyond.x, max(beyond.y, beyond.z)),
                   distance_but_for(missing, first, relevant_count, p));
  }
  // A point must be on the images of enough cameras; only where that is in doubt are they counted.
  int seen[8] = int[8](0, 0, 0, 0, 0, 0, 0, 0);
  int counted = bricks[brick].w != 0 ? parameters.counts.y : 0;
  for (int v = 0; v < counted; ++v)
    for (int j = 0; j < 8; ++j) {
      vec3 p = project(views[v], base + vec3(j >> 2, (j >> 1) & 1, j & 1));
      seen[j] += p.z > 0.0 && on_image(views[v], p.xy / p.z) ? 1 : 0;
    }
  for (int j = 0; j < 8; ++j) {
    ivec3 local = corner + ivec3(j >> 2, (j >> 1) & 1, j & 1);
    bool unseen = counted > 0 && seen[j] < parameters.counts.w;
    distances[brick * 512u + uint((local.x << 6) | (local.y << 3) | local.z)] =
        unseen ? band : clamp(value[j], -band, band);
  }
}

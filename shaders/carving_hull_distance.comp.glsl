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

// The views that matter to a brick, in first_and_views.
struct ViewList {
  uint first;
  int count;
};

// A block of 2^3 voxels, and which of its brick's views the search in it is left with.
struct Block {
  vec3 base;            // its first voxel
  ViewList views;
  int candidate_count;  // views in `candidates`
};

// Places in the brick's list of the views that can be the greatest somewhere in the block; the last place stands
// for all views beyond the list's length.
int candidates[kMaxCandidates];

// Distance in voxels of each of the block's voxels.
float value[8];

// Number of the i-th view of a brick's list.
int listed_view(ViewList list, int i) { return int(first_and_views[list.first + uint(i)]); }

// End of the places in the brick's list that a candidate stands for.
int end_of_candidate(int place, ViewList list) { return place == kMaxCandidates - 1 ? list.count : place + 1; }

// The j-th voxel of a block.
vec3 voxel_of(Block block, int j) { return block.base + vec3(j >> 2, (j >> 1) & 1, j & 1); }

// How far a point is outside the region of interest along the axis where it is farthest; negative inside.
float distance_to_box(vec3 p) {
  vec3 beyond = max(parameters.box_min.xyz - p, p - parameters.box_max.xyz);
  return max(beyond.x, max(beyond.y, beyond.z));
}

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
float distance_but_for(int missing, ViewList list, vec3 p) {
  float greatest[kMostMissing + 1];
  for (int k = 0; k <= missing; ++k) greatest[k] = kNothing;
  for (int i = 0; i < list.count; ++i) {
    int v = listed_view(list, i);
    float d = view_distance(v, views[v], project(views[v], p));
    for (int k = 0; k <= missing; ++k) {
      float lesser = min(greatest[k], d);
      greatest[k] = max(greatest[k], d);
      d = lesser;
    }
  }
  return greatest[missing];
}

// Fills the block's candidates by a look at its centre. Returns the distance of the whole block where the centre
// answers for all of it, else kNothing.
float look_at_centre(inout Block block) {
  float band = parameters.pyramid.w;
  float greatest = kNothing, slack = 0.0;
  float centre[kMaxCandidates];
  for (int i = 0; i < block.views.count; ++i) {
    int v = listed_view(block.views, i);
    GpuView view = views[v];
    vec3 p = project(view, block.base + 0.5);
    float d = near_border(view, p) ? -kNothing : view_distance(v, view, p);
    greatest = d == -kNothing ? greatest : max(greatest, d);
    slack = max(slack, parameters.evidence.x * p.z / view.centre.w);
    centre[min(i, kMaxCandidates - 1)] = i < kMaxCandidates - 1 ? d : -kNothing;
  }
  // Beyond the band the block's centre answers for all of it, unless a frame's border interferes.
  bool answers = abs(greatest) > band + kReach + slack && greatest != kNothing;
  float least = answers ? 1e29 : greatest - 2.0 * kReach - slack;
  block.candidate_count = 0;
  for (int i = 0; i < min(block.views.count, kMaxCandidates); ++i) {
    candidates[block.candidate_count] = i;
    block.candidate_count += centre[i] >= least ? 1 : 0;
  }
  return answers ? greatest : kNothing;
}

// Raises the voxels' distances to the greatest that a candidate says alone.
void take_greatest(Block block) {
  for (int c = 0; c < block.candidate_count; ++c) {
    int end = end_of_candidate(candidates[c], block.views);
    for (int i = candidates[c]; i < end; ++i) {
      int v = listed_view(block.views, i);
      GpuView view = views[v];
      for (int j = 0; j < 8; ++j) {
        vec3 p = project(view, voxel_of(block, j));
        value[j] = max(value[j], view_distance(v, view, p) - parameters.evidence.x * p.z / view.centre.w);
      }
    }
  }
}

// The distance of a voxel at which the evidence of all candidates sums to one, from what a view says alone.
// Evidence rises with the distance, so that of all views that of those beyond s is sum((d - s) / full): the s at
// which it is one, and who is beyond it, settle in some rounds.
float pool_evidence(Block block, vec3 voxel, float alone) {
  float said[kMaxHeard], slopes[kMaxHeard];
  int heard = 0;
  for (int c = 0; c < block.candidate_count; ++c) {
    int end = end_of_candidate(candidates[c], block.views);
    for (int i = candidates[c]; i < end; ++i) {
      int v = listed_view(block.views, i);
      GpuView view = views[v];
      vec3 p = project(view, voxel);
      said[heard] = view_distance(v, view, p);
      slopes[heard] = view.centre.w / (parameters.evidence.x * p.z);
      heard = min(heard + (said[heard] > alone ? 1 : 0), kMaxHeard - 1);
    }
  }
  float pooled = alone, rise = heard > 1 ? 1.0 : 0.0;
  for (int round = 0; round < kMaxRounds && rise > kSettled; ++round) {
    float evidence = -1.0, slope = 1e-6;
    for (int i = 0; i < heard; ++i) {
      float beyond = max(said[i] - pooled, 0.0);
      evidence += beyond * slopes[i];
      slope += beyond > 0.0 ? slopes[i] : 0.0;
    }
    rise = max(evidence / slope, 0.0);
    pooled += rise;
  }
  return pooled;
}

// Writes the block's distances, cut off at the band. A point must be on the images of enough cameras; only where
// that is in doubt (`counted` cameras) are they counted.
void write_distances(Block block, uint brick, ivec3 corner, int counted) {
  int seen[8] = int[8](0, 0, 0, 0, 0, 0, 0, 0);
  for (int v = 0; v < counted; ++v)
    for (int j = 0; j < 8; ++j) {
      vec3 p = project(views[v], voxel_of(block, j));
      seen[j] += p.z > 0.0 && on_image(views[v], p.xy / p.z) ? 1 : 0;
    }
  float band = parameters.pyramid.w;
  for (int j = 0; j < 8; ++j) {
    ivec3 local = corner + ivec3(j >> 2, (j >> 1) & 1, j & 1);
    bool unseen = counted > 0 && seen[j] < parameters.counts.w;
    distances[brick * 512u + uint((local.x << 6) | (local.y << 3) | local.z)] =
        unseen ? band : clamp(value[j], -band, band);
  }
}

// The distances of one block. Software devices run a masked branch in full, so work is skipped by shorter loops,
// not by `if`.
void main() {
  uint brick = work_group().x, thread = gl_LocalInvocationID.x;
  ivec3 corner = 2 * ivec3(thread >> 4u, (thread >> 2u) & 3u, thread & 3u);
  uint first = first_and_views[brick];
  Block block;
  block.base = vec3(bricks[brick].xyz * 8 + corner);
  block.views = ViewList(first, int(first_and_views[brick + 1u] - first));
  float at_centre = look_at_centre(block);

  for (int j = 0; j < 8; ++j) value[j] = max(distance_to_box(voxel_of(block, j)), at_centre);
  take_greatest(block);
  for (int j = 0; j < (parameters.evidence.x > 0.0 && block.candidate_count > 1 ? 8 : 0); ++j)
    value[j] = pool_evidence(block, voxel_of(block, j), value[j]);
  int missing = parameters.limits.x;
  for (int j = 0; j < (missing > 0 ? 8 : 0); ++j) {
    vec3 voxel = voxel_of(block, j);
    value[j] = max(distance_to_box(voxel), distance_but_for(missing, block.views, voxel));
  }
  write_distances(block, brick, corner, bricks[brick].w != 0 ? parameters.counts.y : 0);
}

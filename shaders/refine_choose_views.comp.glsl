#version 450 core
#extension GL_GOOGLE_include_directive : require
// Chooses the views that each surfel is matched in: as reference the worthiest one that sees it,
// then greedily worthy ones at a useful angle from it and from each other. Worth is the cosine
// between normal and direction, times the fourth power of the view's sharpness. Also lists the most
// frontal ones that the surface itself hides it from. One thread a surfel.
// Reference: refine::reference::choose_views.
#include "include/dispatch.glsl"
#include "include/projection.glsl"
#include "include/depth_map.glsl"
#include "shared/refine.h"

layout(local_size_x = 64) in;  // kListedPoints
layout(std140, binding = kChooseParametersBinding) uniform Parameters { ChooseParameters parameters; };
layout(std430, binding = kChooseSurfelsBinding) readonly buffer Surfels { SurfacePoint surfels[]; };
layout(std430, binding = kChooseChoicesBinding) writeonly buffer Choices { MatchChoice choices[]; };
layout(std430, binding = kChooseViewListsBinding) readonly buffer ViewLists { uint view_lists[]; };  // render::list_views

// The worthiest views in falling order of worth; 0 where there are fewer.
float best_worth[kMatchCandidates];
int best_view[kMatchCandidates];

// Puts a view into its place among the worthiest ones.
void insert(int view, float worth) {
  for (int k = 0; k < kMatchCandidates; ++k) {
    bool better = worth > best_worth[k];
    float other_worth = better ? best_worth[k] : worth;
    int other_view = better ? best_view[k] : view;
    best_worth[k] = better ? worth : best_worth[k];
    best_view[k] = better ? view : best_view[k];
    worth = other_worth;
    view = other_view;
  }
}

// The most frontal ones of those that do not see it.
float hidden_cosine[kHiddenViews];
int hidden_view[kHiddenViews];

// Puts a view into its place among the most frontal hidden ones.
void insert_hidden(int view, float cosine) {
  for (int k = 0; k < kHiddenViews; ++k) {
    bool better = cosine > hidden_cosine[k];
    float other_cosine = better ? hidden_cosine[k] : cosine;
    int other_view = better ? hidden_view[k] : view;
    hidden_cosine[k] = better ? cosine : hidden_cosine[k];
    hidden_view[k] = better ? view : hidden_view[k];
    cosine = other_cosine;
    view = other_view;
  }
}

// How many views there are of a kind for a surfel.
struct ViewCounts {
  int seen;        // see it
  int candidates;  // of those the listed ones, not too flat to be matched in
};

// Lists for a surfel the worthiest views that see it and the most frontal ones that something hides it from.
ViewCounts list_candidates(vec3 position, vec3 normal) {
  for (int k = 0; k < kMatchCandidates; ++k) best_worth[k] = 0.0;
  for (int k = 0; k < kMatchCandidates; ++k) best_view[k] = 0;
  for (int k = 0; k < kHiddenViews; ++k) hidden_cosine[k] = 0.0;
  for (int k = 0; k < kHiddenViews; ++k) hidden_view[k] = -1;
  vec3 receiver = position + parameters.visibility.x * normal;
  uint list = work_group().x * uint(parameters.counts.y + 1);
  uint listed = view_lists[list];
  ViewCounts counts = ViewCounts(0, 0);
  for (uint k = 1u; k <= listed; ++k) {
    int v = int(view_lists[list + k]);
    GpuView view = views[v];
    vec3 to_camera = view.centre.xyz - position;
    float cosine = dot(to_camera, normal) * inversesqrt(dot(to_camera, to_camera));
    if (!(cosine > parameters.visibility.w)) continue;
    vec3 p = project(view, receiver);
    vec2 pixel = p.xy / p.z;
    if (p.z <= 1.0 || !on_image(view, pixel)) continue;
    if (!visible(uint(v), pixel, p.z, parameters.visibility.y)) {
      if (cosine > parameters.visibility.z) insert_hidden(v, cosine);
      continue;
    }
    ++counts.seen;
    if (!(cosine > parameters.visibility.z)) continue;
    float energy = view.detail.x * view.detail.x;
    insert(v, cosine * energy * energy);
    ++counts.candidates;
  }
  counts.candidates = min(counts.candidates, kMatchCandidates);
  return counts;
}

// The worthiest candidate whose direction is at a useful angle; -1 where there is none. `nearest`: how near
// each one is to what is chosen already, as a cosine; more than 1 takes it out.
int worthiest(float nearest[kMatchCandidates]) {
  int best = -1;
  float most = 0.0;
  for (int k = 1; k < kMatchCandidates; ++k) {
    // Near-duplicates are worth a third.
    float worth = best_worth[k] * (nearest[k] > parameters.angles.z ? 0.33 : 1.0);
    bool better = nearest[k] <= 1.0 && worth > most;
    most = better ? worth : most;
    best = better ? k : best;
  }
  return best;
}

// Chooses greedily among the listed candidates, the worthiest one first; says how many it chose.
int choose_among(int candidates, vec3 position, out int chosen[kMatchViews]) {
  vec3 direction[kMatchCandidates];
  for (int k = 0; k < kMatchCandidates; ++k)
    direction[k] = normalize(views[best_view[k]].centre.xyz - position);

  chosen = int[kMatchViews](-1, -1, -1, -1, -1, -1);
  int count = candidates > 0 ? 1 : 0;
  chosen[0] = candidates > 0 ? best_view[0] : -1;
  float nearest[kMatchCandidates];
  for (int k = 0; k < kMatchCandidates; ++k) {
    float c = dot(direction[k], direction[0]);
    nearest[k] = k > 0 && k < candidates && c <= parameters.angles.x && c >= parameters.angles.y ? c : 2.0;
  }
  for (int slot = 1; slot < kMatchViews; ++slot) {
    int best = worthiest(nearest);
    if (best < 0) break;
    chosen[slot] = best_view[best];
    ++count;
    vec3 taken = direction[best];
    for (int k = 1; k < kMatchCandidates; ++k)
      nearest[k] = nearest[k] > 1.0 || k == best ? 2.0 : max(nearest[k], dot(direction[k], taken));
  }
  return count;
}

// The choice of one surfel.
void main() {
  uint i = invocation().x;
  if (i >= uint(parameters.counts.x)) return;
  vec3 position = surfels[i].position.xyz, normal = surfels[i].normal.xyz;
  ViewCounts counts = list_candidates(position, normal);
  MatchChoice choice;
  choice.seen = counts.seen;
  choice.count = choose_among(counts.candidates, position, choice.views);
  choice.hidden = hidden_view;
  choices[i] = choice;
}

#version 450 core
#extension GL_GOOGLE_include_directive : require
// Visual hull, coarse to fine: is a cube of voxels outside the hull, inside it, or does the hull's
// surface pass through it? One thread a node. The answer is conservative: a node is called outside or
// inside only if all of its bounding rectangle says so in the min/max mask pyramid.
// Reference: carving::reference::classify_node.
#include "include/dispatch.glsl"
#include "include/projection.glsl"
#include "shared/hull.h"

layout(local_size_x = 64) in;
layout(std140, binding = kHullParametersBinding) uniform Parameters { HullParameters parameters; };
layout(std430, binding = kHullNodesBinding) readonly buffer Nodes { ivec4 nodes[]; };  // xyz in own edges; w: level
layout(std430, binding = kHullClassesBinding) writeonly buffer Classes { uint classes[]; };
// Per node: the views in which the silhouette may matter to its voxels.
layout(std430, binding = kHullRelevantBinding) writeonly buffer Relevant { uint relevant[]; };
layout(binding = kMaskPyramidUnit) uniform sampler2DArray mask_pyramid;
layout(binding = kNodeSilhouettesUnit) uniform sampler2DArray silhouettes;  // signed pixels, positive outside

const float kBrickEdge = 8.0;

// Least and greatest coverage over the cells that a rectangle of pixels touches.
vec2 coverage_range(int view, vec2 low, vec2 high) {
  vec2 cell_low = (low + 0.5) / parameters.pyramid.x;
  vec2 cell_high = (high + 0.5) / parameters.pyramid.x;
  float extent = max(cell_high.x - cell_low.x, cell_high.y - cell_low.y);
  int level = clamp(int(ceil(log2(max(extent, 1.0)))), 0, int(parameters.pyramid.y) - 1);
  ivec2 a = ivec2(floor(cell_low)) >> level, b = ivec2(floor(cell_high)) >> level;
  vec2 range = vec2(1.0, 0.0);
  for (int y = a.y; y <= b.y; ++y)
    for (int x = a.x; x <= b.x; ++x) {
      vec2 cell = texelFetch(mask_pyramid, ivec3(x, y, view), level).rg;
      range = vec2(min(range.x, cell.x), max(range.y, cell.y));
    }
  return range;
}

// Pixel rectangle of the cube centre +- half_edge; false when a corner is behind the camera.
bool bounding_rectangle(GpuView view, vec3 centre, float half_edge, out vec2 low, out vec2 high) {
  vec3 c = project(view, centre);
  vec3 dx = half_edge * vec3(view.row_s.x, view.row_t.x, view.row_q.x);
  vec3 dy = half_edge * vec3(view.row_s.y, view.row_t.y, view.row_q.y);
  vec3 dz = half_edge * vec3(view.row_s.z, view.row_t.z, view.row_q.z);
  low = vec2(1e30);
  high = vec2(-1e30);
  float nearest = 1e30;
  for (int i = 0; i < 8; ++i) {
    vec3 p = c + ((i & 1) != 0 ? dx : -dx) + ((i & 2) != 0 ? dy : -dy) + ((i & 4) != 0 ? dz : -dz);
    nearest = min(nearest, p.z);
    vec2 pixel = p.xy / p.z;
    low = min(low, pixel);
    high = max(high, pixel);
  }
  return nearest > 1e-3;
}

// Signed pixels by which the node's bounding sphere clears the silhouette: positive when all of it
// projects to the background, negative when all of it projects to the object, else 0.
float sphere_clearance(int v, GpuView view, vec3 centre, float radius) {
  vec3 p = project(view, centre);
  vec2 pixel = p.xy / p.z;
  if (p.z <= 2.0 * radius || !on_image(view, pixel)) return 0.0;
  // The silhouette of a sphere off the axis is an ellipse, longer by at most the angle's secant.
  vec2 off_axis = (pixel - 0.5 * view.size.xy) / view.centre.w;
  float radius_px = radius * view.centre.w / (p.z - radius) * sqrt(1.0 + 2.0 * dot(off_axis, off_axis));
  float d = textureLod(silhouettes, vec3(texture_coordinate(view, pixel), float(v)), 0.0).r;
  float clear = abs(d) - radius_px - 1.0;
  return clear > 0.0 ? sign(d) * clear : 0.0;
}

void main() {
  uint id = invocation().x;
  if (id >= uint(parameters.counts.x)) return;
  ivec4 node = nodes[id];
  float edge = kBrickEdge * float(1 << node.w);
  float half_edge = 0.5 * edge + parameters.pyramid.z;
  vec3 centre = vec3(node.xyz) * edge + 0.5 * (edge - 1.0);

  bool out_of_box = any(greaterThan(centre - half_edge, parameters.box_max.xyz)) ||
                    any(lessThan(centre + half_edge, parameters.box_min.xyz));
  bool in_box = all(greaterThanEqual(centre - half_edge, parameters.box_min.xyz)) &&
                all(lessThanEqual(centre + half_edge, parameters.box_max.xyz));
  bool outside = out_of_box, inside = in_box;
  int partly_seen = 0, wholly_seen = 0;
  int rejecting = 0, doubting = 0;  // views that show none of the node, and those that may not show all
  int missing = parameters.limits.x;
  int words = parameters.counts.z;
  for (int word = 0; word < words; ++word) {
    uint bits = 0u;
    for (int v = word * 32; v < min(word * 32 + 32, parameters.counts.y) && !outside; ++v) {
      GpuView view = views[v];
      vec2 low, high;
      if (!bounding_rectangle(view, centre, half_edge, low, high)) {
        // The cube straddles the camera's plane: nothing can be said.
        bool behind = project(view, centre).z < -2.0 * half_edge;
        partly_seen += behind ? 0 : 1;
        if (!behind) bits |= 1u << uint(v & 31);
        inside = inside && behind;
        continue;
      }
      bool disjoint = any(lessThan(high, vec2(-0.5))) || any(greaterThan(low, view.size.xy - 0.5));
      if (disjoint) continue;
      bool whole = on_image(view, low) && on_image(view, high);
      partly_seen += 1;
      wholly_seen += whole ? 1 : 0;
      // One pixel more on each side: samples are bilinear. And as many as one view alone needs to reject a
      // point; nearer its outline it adds to the others' evidence.
      float margin = 1.0 + parameters.evidence.x;
      vec2 range = coverage_range(v, max(low - margin, vec2(-0.5)), min(high + margin, view.size.xy - 0.51));
      if (range.x >= 0.5) continue;
      bool rejects = range.y < 0.5;
      float clearance = rejects ? 0.0 : sphere_clearance(v, view, centre, half_edge * 1.7321);
      if (clearance < -parameters.evidence.x) continue;
      doubting += 1;
      rejecting += whole && (rejects || clearance > parameters.evidence.x) ? 1 : 0;
      outside = outside || rejecting > missing;
      bits |= 1u << uint(v & 31);
    }
    relevant[id * uint(words) + uint(word)] = bits;
  }
  if (doubting > missing) inside = false;
  if (partly_seen < parameters.counts.w) outside = true;
  if (wholly_seen < parameters.counts.w) inside = false;
  classes[id] = (outside ? kNodeOutside : inside ? kNodeInside : kNodeSurface) |
                (wholly_seen < parameters.counts.w ? kNodeUnsure : 0u);
}

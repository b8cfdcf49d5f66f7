// Triangles on a visibility map: containment and depth at any position, so finer than texels.
layout(std430, binding = kMapTrianglesBinding) buffer MapTriangles { MapTriangle map_triangles[]; };  // of each part in turn

MapTriangle triangle_of(int part, uint triangle) {
  return map_triangles[part * map_info.size.w + int(triangle)];
}

// Barycentric coordinates over w, of the vertices other than the anchor, and of the anchor.
vec3 barycentric(MapTriangle t, vec2 at) {
  vec2 d = at - t.anchor.xy;
  float b1 = dot(t.slopes.zw, d), b2 = dot(t.edge2.xy, d);
  return vec3(b1, b2, t.anchor.z + dot(t.slopes.xy, d) - b1 - b2);
}

bool contains(MapTriangle t, vec2 at) {
  return t.anchor.z > 0.0 && all(greaterThanEqual(barycentric(t, at), vec3(0.0)));
}

// Depth of the triangle's plane, within the triangle's depths.
float triangle_depth(MapTriangle t, int part, vec2 at) {
  float inverse_w = t.anchor.z + dot(t.slopes.xy, at - t.anchor.xy);
  return inverse_w <= 0.0 ? t.edge2.w : clamp(depth_at(part, at, 1.0 / inverse_w), t.edge2.z, t.edge2.w);
}

// Least (x) and greatest (y) depth that the triangle may have in a texel.
vec2 depth_range(MapTriangle t, int part, ivec2 texel) {
  vec2 range = vec2(1e30, 0.0);
  for (int k = 0; k < 4; ++k) {
    float z = triangle_depth(t, part, vec2(texel) + vec2(k & 1, k >> 1));
    range = vec2(min(range.x, z), max(range.y, z));
  }
  return range;
}

// Distance from a position outside to the side that is farthest from it, in texels; `outward` is
// that side's normal. Negative inside.
float distance_outside(MapTriangle t, vec2 at, out vec2 outward) {
  vec3 b = barycentric(t, at);
  vec2 sides[3] = {t.slopes.zw, t.edge2.xy, t.slopes.xy - t.slopes.zw - t.edge2.xy};
  float farthest = -1e30;
  for (int i = 0; i < 3; ++i) {
    float steepness = max(length(sides[i]), 1e-30), beyond = -b[i] / steepness;
    if (beyond > farthest) {
      farthest = beyond;
      outward = -sides[i] / steepness;
    }
  }
  return farthest;
}

// The triangle's least height, in texels, as near the viewpoint as its anchor.
float least_height(MapTriangle t) {
  vec2 side0 = t.slopes.xy - t.slopes.zw - t.edge2.xy;
  return t.anchor.z / max(max(length(side0), length(t.slopes.zw)), max(length(t.edge2.xy), 1e-30));
}

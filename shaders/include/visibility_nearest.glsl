// The nearest triangle of each texel, as sub-pixel maps keep it.
layout(std430, binding = kMapListEndsBinding) readonly buffer Nearest { uint nearest_triangles[]; };

int index_of(int part, ivec2 texel) { return (part * map_info.size.y + texel.y) * map_info.size.x + texel.x; }

// Depths of other places than the receiver's differ from its own by its plane's change over a texel.
float slack_beside(Receiver r, MapPoint m) {
  return 2.0 * change_within_texel(r.normal.xyz, m) + texel_width(m.z);
}

// Does a triangle lie at a position, nearer than the receiver by more than `slack`?
bool hides(Receiver r, MapPoint m, uint triangle, vec2 at, float slack) {
  if (triangle == kNoTriangle || triangle == r.id.x) return false;
  MapTriangle t = triangle_of(m.part, triangle);
  return contains(t, at) && triangle_depth(t, m.part, at) < m.z - slack;
}

const float kLargeTriangle = 4.0;  // texels: beyond, a triangle is found wherever it lies

// Where no known triangle lies at the receiver's position: not hidden if its texel's triangle is large,
// for then those beside it would be known. Else hidden if the nearest triangles of the four texels whose
// middles surround it are nearer than it.
// Touched texels reach half a texel beyond a silhouette, and asking four of them takes that back.
bool surrounded(Receiver r, MapPoint m) {
  ivec2 first = ivec2(floor(m.at - 0.5));
  float slack = slack_beside(r, m);
  uint own = nearest_triangles[index_of(m.part, texel_at(m, m.at).xy)];
  if (own == kNoTriangle || least_height(triangle_of(m.part, own)) >= kLargeTriangle) return false;
  for (int k = 0; k < 4; ++k) {
    ivec2 texel = clamp(first + ivec2(k & 1, k >> 1), ivec2(0), map_info.size.xy - 1);
    uint triangle = nearest_triangles[index_of(m.part, texel)];
    if (triangle == kNoTriangle || triangle == r.id.x) return false;
    if (depth_range(triangle_of(m.part, triangle), m.part, texel).y >= m.z - slack) return false;
  }
  return true;
}

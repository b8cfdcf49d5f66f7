// The nearest triangle of each texel, as sub-pixel maps keep it.
layout(std430, binding = 5) readonly buffer Nearest { uint nearest_triangles[]; };

int index_of(int part, ivec2 texel) { return (part * map_info.size.y + texel.y) * map_info.size.x + texel.x; }

// Where no known triangle lies at the receiver's position: hidden only if the nearest triangles of all
// 9 texels around it are nearer than it.
bool surely_hidden(Receiver r, MapPoint m) {
  ivec2 centre = texel_at(m, m.at).xy;
  for (int k = 0; k < 9; ++k) {
    ivec2 texel = clamp(centre + ivec2(k % 3 - 1, k / 3 - 1), ivec2(0), map_info.size.xy - 1);
    uint triangle = nearest_triangles[index_of(m.part, texel)];
    if (triangle == kNoTriangle || triangle == r.id.x) return false;
    if (depth_range(triangle_of(m.part, triangle), m.part, texel).y >= m.z - map_info.bias.x) return false;
  }
  return true;
}

// -1: the triangle does not lie at the receiver's position; 0: it hides it; 1: it does not.
int verdict(Receiver r, MapPoint m, uint triangle) {
  if (triangle == kNoTriangle) return -1;
  MapTriangle t = triangle_of(m.part, triangle);
  if (!contains(t, m.at)) return -1;
  return triangle == r.id.x || triangle_depth(t, m.part, m.at) >= m.z - map_info.bias.x ? 1 : 0;
}

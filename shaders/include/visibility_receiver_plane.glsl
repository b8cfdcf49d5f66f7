// A receiver's tangent plane on a visibility map: 1 / w is linear there.

// How far depth may change within a texel, in widths of a texel: steeper planes are edge-on, and say
// nothing about depths beside the receiver.
const float kSteepest = 16.0;

struct MapPlane {
  vec2 slope;  // of 1 / w
  bool usable; // not edge-on
};

MapPlane plane_of(vec3 normal, MapPoint m) {
  vec3 side = abs(normal.x) < 0.7 ? vec3(1, 0, 0) : vec3(0, 1, 0);
  vec3 u = normalize(cross(normal, side)), v = cross(normal, u);
  vec3 a = homogeneous_step(m.part, m.at, u), b = homogeneous_step(m.part, m.at, v);
  float det = a.x * b.y - a.y * b.x;
  if (det == 0.0) return MapPlane(vec2(0.0), false);
  return MapPlane(vec2(b.z * a.y - a.z * b.y, a.z * b.x - b.z * a.x) / (det * m.w), true);
}

float texel_width(float z) { return map_info.bias.w * z; }

// Change of the plane's depth from a texel's middle to its corner; edge-on, as much as is credible.
float change_within_texel(vec3 normal, MapPoint m) {
  MapPlane plane = plane_of(normal, m);
  float change = m.z * m.w * 0.5 * (abs(plane.slope.x) + abs(plane.slope.y));
  float most = 0.5 * kSteepest * texel_width(m.z);
  return plane.usable ? min(change, most) : most;
}

// A depth that was carried from the receiver to another position, kept within what is credible.
float limited_depth(MapPoint m, float z, vec2 at) {
  vec2 d = abs(at - m.at);
  float most = kSteepest * texel_width(m.z) * (d.x + d.y);
  return clamp(z, m.z - most, m.z + most);
}

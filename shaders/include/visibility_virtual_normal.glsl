// Virtual samples from position and normal [WangMolnar94]: where the ray through a map position meets
// the receiver's tangent plane. Edge-on planes keep the receiver's own depth.
// Reference: visibility::reference::Map::receiver_depth.

vec2 prepare(Receiver r, MapPoint m) {
  MapPlane plane = plane_of(r.normal.xyz, m);
  return plane.usable ? plane.slope : vec2(0.0);
}

float receiver_depth(vec2 prepared, MapPoint m, vec2 at) {
  if (prepared == vec2(0.0)) return m.z;
  float inverse_w = 1.0 / m.w + dot(prepared, at - m.at);
  float behind = m.z + 1e6 * texel_width(m.z);
  return limited_depth(m, inverse_w > 0.0 ? depth_at(m.part, at, 1.0 / inverse_w) : behind, at);
}

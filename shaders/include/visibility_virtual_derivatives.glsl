// Virtual samples from the derivatives of the map's coordinates alone (equations 2 to 6 of
// [BarrosoCeles07]); linear depth takes p's place. Edge-on planes keep the receiver's own depth.
// Reference: visibility::reference::Map::receiver_depth.

vec2 prepare(Receiver r, MapPoint m) {
  vec3 a = homogeneous_step(m.part, m.at, r.step_x.xyz), b = homogeneous_step(m.part, m.at, r.step_y.xyz);
  vec3 row_z = map_info.parts[m.part].row_z.xyz;
  float p_x = dot(row_z, r.step_x.xyz), p_y = dot(row_z, r.step_y.xyz);
  vec2 dx = a.xy / (m.w + a.z), dy = b.xy / (m.w + b.z);  // (4): (ds/dx, dt/dx) and (ds/dy, dt/dy)
  float det = dx.x * dy.y - dx.y * dy.x;                  // (5)
  if (det == 0.0 || m.w + a.z <= 0.0 || m.w + b.z <= 0.0) return vec2(0.0);
  return vec2(dy.y * p_x - dx.y * p_y, dx.x * p_y - dy.x * p_x) / det;  // (6)
}

float receiver_depth(vec2 prepared, MapPoint m, vec2 at) {
  return limited_depth(m, m.z + dot(prepared, at - m.at), at);
}

// Adaptive bias from the receiver's normal [Dou14]: as much as its tangent plane's depth changes from
// the middle of a texel to a corner, and the constant.

float map_depth(Receiver r, MapPoint m, ivec3 texel) {
  MapPlane plane = plane_of(r.normal.xyz, m);
  float change = m.z * m.w * 0.5 * (abs(plane.slope.x) + abs(plane.slope.y));
  float most = 0.5 * kSteepest * texel_width(m.z);
  change = plane.usable ? min(change, most) : most;
  return texelFetch(first_depth, texel, 0).r + change + map_info.bias.x;
}

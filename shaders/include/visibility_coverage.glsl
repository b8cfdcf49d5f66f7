// Maps with coverage detection [Li17]: the triangles linked to the receiver's texel decide where they lie
// at its position. Between triangles that both end near it, a sliver was lost and is filled (border
// recovery); else conservative depths decide. Reference: visibility::reference::Map::coverage.
layout(std430, binding = 6) readonly buffer Links { uvec4 links[]; };

const float kWidestGap = 1.0;  // texels

// Does a triangle linked at a position lie there, before the receiver?
bool hidden_at(Receiver r, MapPoint m, vec2 at) {
  uvec4 linked = links[index_of(m.part, texel_at(m, at).xy)];
  for (int i = 0; i < kMaxLinks && linked[i] != kNoTriangle; ++i) {
    MapTriangle t = triangle_of(m.part, linked[i]);
    if (linked[i] != r.id.x && contains(t, at) && triangle_depth(t, m.part, at) < m.z - map_info.bias.x) return true;
  }
  return false;
}

// Does the receiver lie in a gap between the linked triangle nearest to it and another one beyond?
bool in_gap(Receiver r, MapPoint m, uvec4 linked) {
  float least = kWidestGap;
  vec2 outward = vec2(0.0);
  for (int i = 0; i < kMaxLinks && linked[i] != kNoTriangle; ++i) {
    MapTriangle t = triangle_of(m.part, linked[i]);
    vec2 normal;
    float beyond = t.anchor.z > 0.0 ? distance_outside(t, m.at, normal) : kWidestGap;
    bool before = triangle_depth(t, m.part, m.at) < m.z - map_info.bias.x;
    if (beyond < least && before && linked[i] != r.id.x) {
      least = beyond;
      outward = normal;
    }
  }
  if (least == kWidestGap) return false;
  // Two probes away from the triangle's side, through the gap.
  return hidden_at(r, m, m.at + 0.5 * kWidestGap * outward) || hidden_at(r, m, m.at + kWidestGap * outward);
}

float fraction_visible(Receiver r, MapPoint m) {
  uvec4 linked = links[index_of(m.part, texel_at(m, m.at).xy)];
  bool known = false;
  for (int i = 0; i < kMaxLinks; ++i) {
    int found = verdict(r, m, linked[i]);
    if (found == 0) return 0.0;
    known = known || found == 1;
  }
  if (known) return 1.0;
  return in_gap(r, m, linked) || surely_hidden(r, m) ? 0.0 : 1.0;
}

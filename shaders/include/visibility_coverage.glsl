// Maps with coverage detection [Li17]: the triangles linked to the receiver's texel decide where they lie
// at its position. Between triangles that both end near it, a sliver was lost and is filled (border
// recovery); else the texels around decide. Reference: visibility::reference::Map::coverage.
#include "include/visibility_links.glsl"

const float kWidestGap = 1.0;  // texels

// Does a triangle linked at a position beside the receiver's hide it?
bool hidden_beside(Receiver r, MapPoint m, vec2 at, float slack) {
  uvec4 linked = links_of(m.part, texel_at(m, at).xy);
  for (int i = 0; i < kMaxLinks; ++i)
    if (hides(r, m, linked[i], at, slack)) return true;
  return false;
}

// Does the receiver lie in a gap between the linked triangle nearest to it and another one beyond?
bool in_gap(Receiver r, MapPoint m, uvec4 linked) {
  float least = kWidestGap, slack = slack_beside(r, m);
  vec2 outward = vec2(0.0);
  for (int i = 0; i < kMaxLinks && linked[i] != kNoTriangle; ++i) {
    MapTriangle t = triangle_of(m.part, linked[i]);
    vec2 normal;
    float beyond = t.anchor.z > 0.0 ? distance_outside(t, m.at, normal) : kWidestGap;
    bool before = triangle_depth(t, m.part, m.at) < m.z - slack;
    if (beyond < least && before && linked[i] != r.id.x) {
      least = beyond;
      outward = normal;
    }
  }
  if (least == kWidestGap) return false;
  // Two probes away from the triangle's side, through the gap.
  return hidden_beside(r, m, m.at + 0.5 * kWidestGap * outward, slack) ||
         hidden_beside(r, m, m.at + kWidestGap * outward, slack);
}

float fraction_visible(Receiver r, MapPoint m) {
  uvec4 linked = links_of(m.part, texel_at(m, m.at).xy);
  for (int i = 0; i < kMaxLinks; ++i)
    if (hides(r, m, linked[i], m.at, map_info.bias.x)) return 0.0;
  return in_gap(r, m, linked) || surrounded(r, m) ? 0.0 : 1.0;
}

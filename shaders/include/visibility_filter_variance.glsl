// Variance maps [DonnellyLauritzen06]: Chebyshev's bound on the share of the filtered texels that lie
// beyond the receiver, from the moments of their depths. Reference: visibility::reference::Map::variance.
const float kLeastVariance = 1e-7;  // of depths from 0 to 1

float fraction_visible(Receiver r, MapPoint m) {
  if (map_info.range.y <= map_info.range.x) return 1.0;  // nothing is there
  float z = min((m.z - map_info.bias.x - map_info.range.x) / (map_info.range.y - map_info.range.x), 1.0);
  vec2 moments = textureLod(depth_moments, vec3(m.at / vec2(map_info.size.xy), m.part), 0.0).rg;
  if (z <= moments.x) return 1.0;
  float variance = max(moments.y - moments.x * moments.x, kLeastVariance);
  float bound = variance / (variance + (z - moments.x) * (z - moments.x));
  return clamp((bound - map_info.range.z) / (1.0 - map_info.range.z), 0.0, 1.0);
}

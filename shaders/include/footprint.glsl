// A square on an oriented plane as a view sees it: projective texture mapping of its centre, with the
// exact Jacobian there [Segal92; Heckbert89].
#include "include/projection.glsl"

struct Footprint {
  vec2 pixel;   // where the centre falls
  vec2 du, dv;  // how that moves along the square's edges, pixels
  vec3 scale;   // xy: reciprocal size of the array texture; z: its layer
};

// Singular values of the Jacobian and the direction of the greater.
struct FootprintAxes {
  float longer, shorter;
  vec2 direction;
};

// From homogeneous coordinates (s, t, q) of the centre and their steps along the edges. q, the
// distance to the image plane, must be positive. Quotient rule on s / q and t / q; what lies nearly in
// the camera's own plane is held finite.
Footprint footprint_of(GpuView view, uint v, vec3 at, vec3 by_u, vec3 by_v) {
  Footprint f;
  f.pixel = clamp(at.xy / at.z, vec2(-1e6), vec2(1e6));
  f.du = clamp((by_u.xy - f.pixel * by_u.z) / at.z, vec2(-1e6), vec2(1e6));
  f.dv = clamp((by_v.xy - f.pixel * by_v.z) / at.z, vec2(-1e6), vec2(1e6));
  f.scale = vec3(view.size.zw, float(v));
  return f;
}

FootprintAxes axes_of(Footprint f) {
  float xx = f.du.x * f.du.x + f.dv.x * f.dv.x, yy = f.du.y * f.du.y + f.dv.y * f.dv.y;
  float xy = f.du.x * f.du.y + f.dv.x * f.dv.y;
  float half_gap = 0.5 * (xx - yy), root = sqrt(half_gap * half_gap + xy * xy);
  FootprintAxes axes;
  axes.longer = sqrt(max(0.5 * (xx + yy) + root, 0.0));
  axes.shorter = axes.longer > 0.0 ? abs(f.du.x * f.dv.y - f.du.y * f.dv.x) / axes.longer : 0.0;
  vec2 direction = half_gap >= 0.0 ? vec2(half_gap + root, xy) : vec2(xy, root - half_gap);
  float size = max(abs(direction.x), abs(direction.y));
  axes.direction = size > 0.0 ? normalize(direction / size) : vec2(1.0, 0.0);
  return axes;
}

// Sides of the upright rectangle with the footprint's second moments, pixels.
vec2 upright_sides(Footprint f) {
  return vec2(length(vec2(f.du.x, f.dv.x)), length(vec2(f.du.y, f.dv.y)));
}

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

const float kLeastDepth = 0.1;   // voxels: keeps the squares of lengths finite
const float kFarthest = 1e6;     // pixels, of positions that loops run over

// From homogeneous coordinates (s, t, q) of the centre and their steps along the edges. q, the
// distance to the image plane, must be positive. Quotient rule on s / q and t / q; what lies nearly in
// the camera's own plane is held finite.
Footprint footprint_of(GpuView view, uint v, vec3 at, vec3 by_u, vec3 by_v) {
  Footprint f;
  float nearness = 1.0 / max(at.z, kLeastDepth);
  f.pixel = at.xy * nearness;
  f.du = (by_u.xy - f.pixel * by_u.z) * nearness;
  f.dv = (by_v.xy - f.pixel * by_v.z) * nearness;
  f.scale = vec3(view.size.zw, float(v));
  return f;
}

FootprintAxes axes_of(Footprint f) {
  float xx = f.du.x * f.du.x + f.dv.x * f.dv.x, yy = f.du.y * f.du.y + f.dv.y * f.dv.y;
  float xy = f.du.x * f.du.y + f.dv.x * f.dv.y;
  float half_gap = 0.5 * (xx - yy), root = sqrt(half_gap * half_gap + xy * xy);
  FootprintAxes axes;
  axes.longer = sqrt(0.5 * (xx + yy) + root);
  axes.shorter = abs(f.du.x * f.dv.y - f.du.y * f.dv.x) / max(axes.longer, 1e-18);
  vec2 direction = half_gap >= 0.0 ? vec2(half_gap + root, xy) : vec2(xy, root - half_gap);
  float squared = dot(direction, direction);
  axes.direction = squared > 1e-30 ? direction * inversesqrt(squared) : vec2(1.0, 0.0);
  return axes;
}

// Sides of the upright rectangle with the footprint's second moments, pixels.
vec2 upright_sides(Footprint f) {
  return vec2(length(vec2(f.du.x, f.dv.x)), length(vec2(f.du.y, f.dv.y)));
}

#version 450 core
#extension GL_GOOGLE_include_directive : require
// Fits a patch to the photographs: Gauss-Newton on its offset along the surfel's normal and its two
// slopes, for the least robust sum of squared differences between the chosen views and their mean,
// each view's patch first brought to zero mean and unit variance (the image noise as a floor of it).
// All three parameters move a tap along the normal, so that one directional derivative of the image
// a tap makes all derivatives. One thread a surfel. Reference: refine::reference::fit_patch.
#include "include/dispatch.glsl"
#include "include/projection.glsl"
#include "include/patch.glsl"
#include "shared/refine.h"

layout(local_size_x = 64) in;  // kPatchGroup
layout(std140, binding = kFitParametersBinding) uniform Parameters { FitParameters parameters; };
layout(std430, binding = kFitSurfelsBinding) readonly buffer Surfels { SurfacePoint surfels[]; };
layout(std430, binding = kFitChoicesBinding) readonly buffer Choices { MatchChoice choices[]; };
layout(std430, binding = kFitResultsBinding) writeonly buffer Results { FitResult results[]; };
layout(std430, binding = kFitShapesBinding) readonly buffer Shapes { FitShape shapes[]; };

const float kValues = 3.0 * float(kTaps);
// Variance of a derivative (per texel) over that of a value (the mean of two fetches) where both are
// noise of independent texels: bilinear weights, averaged over places and directions.
const float kDerivativeNoise = 2.4;

// A quadratic model of the cost about one patch: half the sum over views of w |x - mean|^2.
struct Model {
  mat3 hessian;
  vec3 gradient;
  float score;     // mean correlation of the views with those before them, from the least score up
  float variance;  // of a value about the mean
  float held;      // correlation of the view held out
  float noise;     // what variance alone makes of the hessian's entry for the offset
};

// Of the view in hand: colours of the taps, then those normalised; derivatives along the normal.
vec3 value[kTaps], slope[kTaps];
// Weighted sums over the views so far: normalised colours, and their derivatives by the parameters.
vec3 sum_value[kTaps], sum_d0[kTaps], sum_d1[kTaps], sum_d2[kTaps];

// Fills value and slope, and how many texels a tap moves per voxel; false where the patch is not
// before the camera. Each tap is fetched half a texel to both sides along the direction in which it
// moves.
bool fetch(int v, vec3 centre, vec3 normal, vec3 u, vec3 w, vec2 slopes, vec3 bend,
           out float per_voxel) {
  GpuView view = views[v];
  vec3 p = project(view, centre);
  bool before = p.z > 1.0;
  float depth = before ? p.z : 1.0;
  vec2 pixel = before ? p.xy / depth : vec2(0.0);
  vec3 s = view.row_s.xyz - pixel.x * view.row_q.xyz, t = view.row_t.xyz - pixel.y * view.row_q.xyz;
  vec2 du = vec2(dot(s, u), dot(t, u)) / depth, dv = vec2(dot(s, w), dot(t, w)) / depth;
  vec2 dn = vec2(dot(s, normal), dot(t, normal)) / depth;
  float lod = floor(max(0.5 * log2(abs(du.x * dv.y - du.y * dv.x)), 0.0) + 0.5);
  float speed = length(dn);
  float reach = 0.5 * exp2(lod);
  vec2 aside = dn * (reach / max(speed, 1e-6)) * view.size.zw;
  per_voxel = speed / (2.0 * reach);  // texels
  vec2 origin = texture_coordinate(view, pixel);
  du = (du + slopes.x * dn) * view.size.zw;
  dv = (dv + slopes.y * dn) * view.size.zw;
  dn *= view.size.zw;
  for (int k = 0; k < kTaps; ++k) {
    vec2 at = place_of_tap(k);
    float height = dot(bend, vec3(at.x * at.x, at.x * at.y, at.y * at.y));
    vec2 place = origin + at.x * du + at.y * dv + height * dn;
    vec3 a = sqrt(max(textureLod(images, vec3(place - aside, float(v)), lod).rgb, 0.0));
    vec3 b = sqrt(max(textureLod(images, vec3(place + aside, float(v)), lod).rgb, 0.0));
    value[k] = 0.5 * (a + b) - 0.5;
    slope[k] = (b - a) * per_voxel;
  }
  return before;
}

Model evaluate(int chosen[kMatchViews], int count, int held, vec3 centre, vec3 normal, vec3 u, vec3 w,
               vec2 slopes, vec3 bend) {
  float noise = kValues * parameters.robust.x;
  for (int k = 0; k < kTaps; ++k) {
    sum_value[k] = vec3(0.0);
    sum_d0[k] = vec3(0.0);
    sum_d1[k] = vec3(0.0);
    sum_d2[k] = vec3(0.0);
  }
  Model m;
  m.hessian = mat3(0.0);
  m.gradient = vec3(0.0);
  m.held = kNoScore;
  float weights = 0.0, squares = 0.0, floors = 0.0, scores = 0.0, speeds = 0.0;
  int scored = 0;
  for (int v = 0; v < count; ++v) {
    float per_voxel;
    bool before = fetch(chosen[v], centre, normal, u, w, slopes, bend, per_voxel);
    vec3 mean = vec3(0.0), mean0 = vec3(0.0), mean1 = vec3(0.0), mean2 = vec3(0.0);
    float square = 0.0;
    for (int k = 0; k < kTaps; ++k) {
      vec2 at = place_of_tap(k);
      mean += value[k];
      square += dot(value[k], value[k]);
      mean0 += slope[k];
      mean1 += at.x * slope[k];
      mean2 += at.y * slope[k];
    }
    const float n = 1.0 / float(kTaps);
    float scale = inversesqrt(max(square - n * dot(mean, mean), 0.0) + noise);
    mean *= n;
    mean0 *= n;
    mean1 *= n;
    mean2 *= n;
    float correlation = 0.0, own = 0.0;
    vec3 along = vec3(0.0);  // products of the normalised colours with their derivatives
    for (int k = 0; k < kTaps; ++k) {
      vec2 at = place_of_tap(k);
      vec3 x = (value[k] - mean) * scale;
      value[k] = x;
      correlation += dot(x, sum_value[k]);
      own += dot(x, x);
      float product = dot(x, slope[k]) * scale;
      along += product * vec3(1.0, at);
    }
    correlation /= max(weights, 1e-6);
    bool first = weights == 0.0;
    float share = clamp((correlation - parameters.robust.y) / (parameters.robust.z - parameters.robust.y), 0.0, 1.0);
    bool counts = before && v != held;
    float weight = counts ? (first ? 1.0 : share * share) : 0.0;
    m.held = before && v == held ? correlation : m.held;
    scores += counts && !first ? max(correlation, parameters.robust.y) : 0.0;
    scored += counts && !first ? 1 : 0;
    weights += weight;
    squares += weight * own;
    speeds += weight * per_voxel * per_voxel;
    floors += weight * (1.0 - own);
    mat3 h = mat3(0.0);
    for (int k = 0; k < kTaps; ++k) {
      vec2 at = place_of_tap(k);
      vec3 x = value[k];
      vec3 d0 = (slope[k] - mean0) * scale - along.x * x;
      vec3 d1 = (at.x * slope[k] - mean1) * scale - along.y * x;
      vec3 d2 = (at.y * slope[k] - mean2) * scale - along.z * x;
      h[0] += vec3(dot(d0, d0), dot(d0, d1), dot(d0, d2));
      h[1].y += dot(d1, d1);
      h[1].z += dot(d1, d2);
      h[2].z += dot(d2, d2);
      m.gradient += weight * vec3(dot(d0, x), dot(d1, x), dot(d2, x));
      sum_value[k] += weight * x;
      sum_d0[k] += weight * d0;
      sum_d1[k] += weight * d1;
      sum_d2[k] += weight * d2;
    }
    m.hessian += weight * h;
  }
  float per_weight = 1.0 / max(weights, 1e-6), joint = 0.0;
  for (int k = 0; k < kTaps; ++k) {
    vec3 x = sum_value[k], d0 = sum_d0[k], d1 = sum_d1[k], d2 = sum_d2[k];
    joint += dot(x, x);
    m.gradient -= per_weight * vec3(dot(d0, x), dot(d1, x), dot(d2, x));
    m.hessian[0] -= per_weight * vec3(dot(d0, d0), dot(d0, d1), dot(d0, d2));
    m.hessian[1].y -= per_weight * dot(d1, d1);
    m.hessian[1].z -= per_weight * dot(d1, d2);
    m.hessian[2].z -= per_weight * dot(d2, d2);
  }
  m.hessian[1].x = m.hessian[0].y;
  m.hessian[2].x = m.hessian[0].z;
  m.hessian[2].y = m.hessian[1].z;
  float cost = max(squares - per_weight * joint, 0.0);
  m.variance = max(cost / max(weights - 1.0, 0.5), floors * per_weight) / kValues;
  m.noise = kDerivativeNoise * kValues * m.variance * speeds * max(1.0 - per_weight, 0.0);
  m.score = scored > 0 ? scores / float(scored) : kNoScore;
  return m;
}

void main() {
  uint i = invocation().x;
  if (i >= uint(parameters.counts.x)) return;
  vec3 position = surfels[i].position.xyz, normal = surfels[i].normal.xyz;
  vec4 curvature = shapes[i].curvature;
  int chosen[kMatchViews] = int[kMatchViews](choices[i].first.x, choices[i].first.y, choices[i].first.z,
                                             choices[i].first.w, choices[i].second.x, choices[i].second.y);
  int count = choices[i].second.w;
  int held = curvature.w > 0.0 && count > 3 ? count - 1 : -1;
  if (count < 2) {
    results[i].plane = vec4(normal, 0.0);
    results[i].evidence = vec4(0.0, kNoScore, kNoScore, kNoScore);
    return;
  }
  vec3 u, w;
  patch_axes(position, normal, views[chosen[0]], parameters.search.x, parameters.search.y, u, w);
  float spacing = length(u);
  vec3 bend = vec3(0.5, 1.0, 0.5) * curvature.xyz * (spacing * spacing);
  float steep = parameters.robust.w * spacing;  // standard deviation of a slope, voxels a tap

  vec3 theta = vec3(0.0), best_theta = theta;  // offset, slopes in voxels a tap
  Model best;
  float damping = 0.01, held_before = kNoScore;
  for (int step = 0; step <= parameters.counts.z; ++step) {
    Model m = evaluate(chosen, count, held, position + theta.x * normal, normal, u, w, theta.yz, bend);
    held_before = step == 0 ? m.held : held_before;
    bool better = step == 0 || m.score > best.score;
    if (better) {
      best = m;
      best_theta = theta;
    }
    damping *= better ? 0.5 : 10.0;
    float prior = best.variance / (steep * steep);
    mat3 a = best.hessian;
    a[0].x = a[0].x * (1.0 + damping) + 1e-4;
    a[1].y = a[1].y * (1.0 + damping) + prior + 1e-4;
    a[2].z = a[2].z * (1.0 + damping) + prior + 1e-4;
    vec3 move = -(inverse(a) * (best.gradient + vec3(0.0, prior * best_theta.yz)));
    move *= min(1.0, parameters.search.w / max(abs(move.x), 1e-6));
    theta = best_theta + move;
    theta.x = clamp(theta.x, -parameters.search.z, parameters.search.z);
    theta.yz = clamp(theta.yz, -3.0 * steep, 3.0 * steep);
  }

  // What the images say of the offset when the slopes are left to them and to what the surface knows.
  // Noise has derivatives too, which say nothing; a slope's taps lie twice as far out in the mean
  // square as an offset's.
  float prior = best.variance / (steep * steep) + 1e-6;
  mat3 h = best.hessian;
  float a = max(h[1].y - 2.0 * best.noise, 0.0) + prior, b = h[1].z;
  float c = max(h[2].z - 2.0 * best.noise, 0.0) + prior, d = h[0].y, e = h[0].z;
  float marginal =
      h[0].x - best.noise - (d * d * c - 2.0 * d * e * b + e * e * a) / max(a * c - b * b, 1e-12);
  float information = best.score > kNoScore ? max(marginal, 0.0) / max(best.variance, 1e-12) : 0.0;
  results[i].plane = vec4(normalize(normal - (best_theta.y * u + best_theta.z * w) / (spacing * spacing)),
                          best_theta.x);
  results[i].evidence = vec4(information, best.score, held_before, best.held);
}

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

// What normalises the view in hand.
struct Normalisation {
  vec3 mean;                 // of the colours
  float scale;               // 1 / root of the sum of their squares about it, with the noise as a floor
  vec3 mean0, mean1, mean2;  // of the colours' derivatives by the parameters
};

// The view in hand after its normalisation.
struct NormalisedView {
  float correlation;  // with the weighted mean of the views before it
  float square;       // sum of its squares: 1 but for the noise floor
  vec3 along;         // products of the colours with their derivatives
};

// Sums over the views so far, each times its weight but for the last two.
struct ViewSums {
  float weights;
  float squares;  // of the normalised colours
  float floors;   // what the noise floor takes from the squares
  float speeds;   // squared texels that a tap moves per voxel
  int scored;     // views compared with those before them
  float scores;   // their correlations, from the least score up
};

// Of the view in hand: colours of the taps, then those normalised; derivatives along the normal.
vec3 value[kTaps], slope[kTaps];
// Weighted sums over the views so far: normalised colours, and their derivatives by the parameters.
vec3 sum_value[kTaps], sum_d0[kTaps], sum_d1[kTaps], sum_d2[kTaps];

// Fills value and slope of a view that sees the patch, tilted by `slopes` (voxels a tap), and says how many
// texels a tap moves per voxel; false where the patch is not before the camera. Each tap is fetched half a
// texel to both sides along the direction in which it moves.
bool fetch(int v, TangentPatch t, vec2 slopes, out float per_voxel) {
  GpuView view = views[v];
  vec3 p = project(view, t.centre);
  bool before = p.z > 1.0;
  float depth = before ? p.z : 1.0;
  vec2 pixel = before ? p.xy / depth : vec2(0.0);
  vec3 by_s = view.row_s.xyz - pixel.x * view.row_q.xyz, by_t = view.row_t.xyz - pixel.y * view.row_q.xyz;
  vec2 du = vec2(dot(by_s, t.u), dot(by_t, t.u)) / depth, dv = vec2(dot(by_s, t.w), dot(by_t, t.w)) / depth;
  vec2 dn = vec2(dot(by_s, t.normal), dot(by_t, t.normal)) / depth;
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
    float height = dot(t.bend, vec3(at.x * at.x, at.x * at.y, at.y * at.y));
    vec2 place = origin + at.x * du + at.y * dv + height * dn;
    vec3 a = sqrt(max(textureLod(images, vec3(place - aside, float(v)), lod).rgb, 0.0));
    vec3 b = sqrt(max(textureLod(images, vec3(place + aside, float(v)), lod).rgb, 0.0));
    value[k] = 0.5 * (a + b) - 0.5;
    slope[k] = (b - a) * per_voxel;
  }
  return before;
}

// Empties the weighted sums over the views.
void clear_sums() {
  for (int k = 0; k < kTaps; ++k) {
    sum_value[k] = vec3(0.0);
    sum_d0[k] = vec3(0.0);
    sum_d1[k] = vec3(0.0);
    sum_d2[k] = vec3(0.0);
  }
}

// What brings the colours of the view in hand to zero mean and unit variance.
Normalisation normalisation_of_view() {
  float noise = kValues * parameters.robust.x;
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
  return Normalisation(mean, scale, mean0, mean1, mean2);
}

// Normalises the colours of the view in hand, and compares them with the views before it, whose weights sum
// to `weights`.
NormalisedView normalise_view(Normalisation by, float weights) {
  NormalisedView view = NormalisedView(0.0, 0.0, vec3(0.0));
  for (int k = 0; k < kTaps; ++k) {
    vec2 at = place_of_tap(k);
    vec3 x = (value[k] - by.mean) * by.scale;
    value[k] = x;
    view.correlation += dot(x, sum_value[k]);
    view.square += dot(x, x);
    float product = dot(x, slope[k]) * by.scale;
    view.along += product * vec3(1.0, at);
  }
  view.correlation /= max(weights, 1e-6);
  return view;
}

// Weight of a view by its correlation with those before it: none for one that contradicts them.
float robust_weight(float correlation) {
  float share = clamp((correlation - parameters.robust.y) / (parameters.robust.z - parameters.robust.y), 0.0, 1.0);
  return share * share;
}

// Adds a view to the sums, unless it does not count, and returns its weight; the first one has weight 1.
float weigh_view(NormalisedView view, float per_voxel, bool counts, inout ViewSums sums) {
  bool first = sums.weights == 0.0;
  float robust = robust_weight(view.correlation);
  float weight = counts ? (first ? 1.0 : robust) : 0.0;
  sums.scores += counts && !first ? max(view.correlation, parameters.robust.y) : 0.0;
  sums.scored += counts && !first ? 1 : 0;
  sums.weights += weight;
  sums.squares += weight * view.square;
  sums.speeds += weight * per_voxel * per_voxel;
  sums.floors += weight * (1.0 - view.square);
  return weight;
}

// Adds the view in hand to the model about zero, and its colours and derivatives to the sums over the views.
void add_view(Normalisation by, vec3 along, float weight, inout Model m) {
  mat3 h = mat3(0.0);
  for (int k = 0; k < kTaps; ++k) {
    vec2 at = place_of_tap(k);
    vec3 x = value[k];
    vec3 d0 = (slope[k] - by.mean0) * by.scale - along.x * x;
    vec3 d1 = (at.x * slope[k] - by.mean1) * by.scale - along.y * x;
    vec3 d2 = (at.y * slope[k] - by.mean2) * by.scale - along.z * x;
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

// Makes the model one about the views' mean, and completes its symmetric hessian. Returns the square of the
// sum over the views, which is the mean's share of their squares, times the weights.
float eliminate_mean(float per_weight, inout Model m) {
  float joint = 0.0;
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
  return joint;
}

// The model about a patch tilted by `slopes`, of the chosen views but the `held`-th, which is only compared.
Model evaluate(MatchChoice choice, int held, TangentPatch t, vec2 slopes) {
  clear_sums();
  Model m;
  m.hessian = mat3(0.0);
  m.gradient = vec3(0.0);
  m.held = kNoScore;
  ViewSums sums = ViewSums(0.0, 0.0, 0.0, 0.0, 0, 0.0);
  for (int v = 0; v < choice.count; ++v) {
    float per_voxel;
    bool before = fetch(choice.views[v], t, slopes, per_voxel);
    Normalisation by = normalisation_of_view();
    NormalisedView view = normalise_view(by, sums.weights);
    m.held = before && v == held ? view.correlation : m.held;
    float weight = weigh_view(view, per_voxel, before && v != held, sums);
    add_view(by, view.along, weight, m);
  }
  float per_weight = 1.0 / max(sums.weights, 1e-6);
  float joint = eliminate_mean(per_weight, m);
  float cost = max(sums.squares - per_weight * joint, 0.0);
  m.variance = max(cost / max(sums.weights - 1.0, 0.5), sums.floors * per_weight) / kValues;
  m.noise = kDerivativeNoise * kValues * m.variance * sums.speeds * max(1.0 - per_weight, 0.0);
  m.score = sums.scored > 0 ? sums.scores / float(sums.scored) : kNoScore;
  return m;
}

// The damped Gauss-Newton step from `theta`, where the model was made; `prior` is what draws the slopes to zero.
vec3 damped_step(Model m, vec3 theta, float prior, float damping) {
  mat3 a = m.hessian;
  a[0].x = a[0].x * (1.0 + damping) + 1e-4;
  a[1].y = a[1].y * (1.0 + damping) + prior + 1e-4;
  a[2].z = a[2].z * (1.0 + damping) + prior + 1e-4;
  vec3 move = -(inverse(a) * (m.gradient + vec3(0.0, prior * theta.yz)));
  return move * min(1.0, parameters.search.w / max(abs(move.x), 1e-6));
}

// What the images say of the offset when the slopes are left to them and to what the surface knows, whose
// slopes have the standard deviation `steep`. Noise has derivatives too, which say nothing; a slope's taps lie
// twice as far out in the mean square as an offset's.
float information_on_offset(Model m, float steep) {
  float prior = m.variance / (steep * steep) + 1e-6;
  mat3 h = m.hessian;
  float a = max(h[1].y - 2.0 * m.noise, 0.0) + prior, b = h[1].z;
  float c = max(h[2].z - 2.0 * m.noise, 0.0) + prior, d = h[0].y, e = h[0].z;
  float marginal =
      h[0].x - m.noise - (d * d * c - 2.0 * d * e * b + e * e * a) / max(a * c - b * b, 1e-12);
  return m.score > kNoScore ? max(marginal, 0.0) / max(m.variance, 1e-12) : 0.0;
}

// Fits the patch of one surfel.
void main() {
  uint i = invocation().x;
  if (i >= uint(parameters.counts.x)) return;
  vec3 position = surfels[i].position.xyz, normal = surfels[i].normal.xyz;
  vec4 curvature = shapes[i].curvature;
  MatchChoice choice = choices[i];
  int held = curvature.w > 0.0 && choice.count > 3 ? choice.count - 1 : -1;
  if (choice.count < 2) {
    results[i].plane = vec4(normal, 0.0);
    results[i].evidence = vec4(0.0, kNoScore, kNoScore, kNoScore);
    return;
  }
  TangentPatch t = tangent_patch(position, normal, views[choice.views[0]], parameters.search.x, parameters.search.y);
  float spacing = length(t.u);
  t.bend = vec3(0.5, 1.0, 0.5) * curvature.xyz * (spacing * spacing);
  float steep = parameters.robust.w * spacing;  // standard deviation of a slope, voxels a tap

  vec3 theta = vec3(0.0), best_theta = theta;  // offset, slopes in voxels a tap
  Model best;
  float damping = 0.01, held_before = kNoScore;
  for (int step = 0; step <= parameters.counts.z; ++step) {
    t.centre = position + theta.x * normal;
    Model m = evaluate(choice, held, t, theta.yz);
    held_before = step == 0 ? m.held : held_before;
    bool better = step == 0 || m.score > best.score;
    if (better) {
      best = m;
      best_theta = theta;
    }
    damping *= better ? 0.5 : 10.0;
    theta = best_theta + damped_step(best, best_theta, best.variance / (steep * steep), damping);
    theta.x = clamp(theta.x, -parameters.search.z, parameters.search.z);
    theta.yz = clamp(theta.yz, -3.0 * steep, 3.0 * steep);
  }
  results[i].plane = vec4(normalize(normal - (best_theta.y * t.u + best_theta.z * t.w) / (spacing * spacing)),
                          best_theta.x);
  results[i].evidence = vec4(information_on_offset(best, steep), best.score, held_before, best.held);
}

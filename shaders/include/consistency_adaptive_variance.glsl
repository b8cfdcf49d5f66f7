// Variance of the voxel's own colour over the views [SeitzDyer97; KutulakosSeitz00] against a threshold
// from the images' measured noise and the texture around it. Confidence: from the number of views.
// Reference: carving::reference::adaptive_variance.
Consistency consistency(uint base, inout uint seen) {
  uint taps = common_taps(base, seen);
  int n = bitCount(seen);
  if (n < 2 || bitCount(taps) < kLeastTaps) return Consistency(-1.0, 0.0, n);
  vec3 mean = vec3(0.0);
  float texture = 0.0;
  for (int i = 0; i < kViews; ++i) {
    if (!has(seen, i)) continue;
    mean += patch_tap(base, i, kPatchTaps / 2).rgb;
    texture += patch_texture(base, i, taps);
  }
  mean /= float(n);
  float variance = 0.0;
  for (int i = 0; i < kViews; ++i) {
    vec3 d = patch_tap(base, i, kPatchTaps / 2).rgb - mean;
    variance += has(seen, i) ? dot(d, d) : 0.0;
  }
  variance /= 3.0 * float(n - 1);
  float allowed = allowed_variance(parameters.noise.x, texture / float(n));
  return Consistency(score_of_variance(variance, allowed), 1.0 - 1.0 / float(n), n);
}

// Robust variance: of the two thirds of the views whose patches lie nearest to the median patch, against
// the adaptive threshold; a few views that see something else (glints, wrong visibility) do no harm.
// Confidence: from the number of views left. Reference: carving::reference::robust_variance.
Consistency consistency(uint base, inout uint seen) {
  uint taps = common_taps(base, seen);
  int n = bitCount(seen);
  if (n < 2 || bitCount(taps) < kLeastTaps) return Consistency(-1.0, 0.0, n);
  float distance_to_median[kViews];
  for (int i = 0; i < kViews; ++i) distance_to_median[i] = 0.0;
  for (int k = 0; k < kPatchTaps; ++k) {
    if (!has(taps, k)) continue;
    // Median of each channel, by inserting the views' colours in order; absent ones go to the end.
    vec3 sorted[kViews];
    for (int i = 0; i < kViews; ++i) {
      vec3 x = has(seen, i) ? patch_tap(base, i, k).rgb : vec3(1e30);
      for (int j = 0; j < i; ++j) {
        vec3 low = min(sorted[j], x);
        x = max(sorted[j], x);
        sorted[j] = low;
      }
      sorted[i] = x;
    }
    vec3 median = 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]);
    for (int i = 0; i < kViews; ++i) {
      vec3 d = has(seen, i) ? patch_tap(base, i, k).rgb - median : vec3(0.0);
      distance_to_median[i] += dot(d, d);
    }
  }
  int used = max(2, (2 * n + 2) / 3);
  uint kept = 0u;
  for (int i = 0; i < kViews; ++i) {
    int nearer = 0;
    for (int j = 0; j < kViews; ++j)
      nearer += has(seen, j) && (distance_to_median[j] < distance_to_median[i] ||
                            (distance_to_median[j] == distance_to_median[i] && j < i)) ? 1 : 0;
    kept |= has(seen, i) && nearer < used ? 1u << uint(i) : 0u;
  }
  float variance = 0.0, texture = 0.0;
  for (int i = 0; i < kViews; ++i) texture += has(kept, i) ? patch_texture(base, i, taps) : 0.0;
  for (int k = 0; k < kPatchTaps; ++k) {
    if (!has(taps, k)) continue;
    vec3 mean = vec3(0.0);
    for (int i = 0; i < kViews; ++i) mean += has(kept, i) ? patch_tap(base, i, k).rgb : vec3(0.0);
    mean /= float(used);
    for (int i = 0; i < kViews; ++i) {
      vec3 d = has(kept, i) ? patch_tap(base, i, k).rgb - mean : vec3(0.0);
      variance += dot(d, d);
    }
  }
  variance /= 3.0 * float(bitCount(taps)) * float(used - 1);
  float allowed = allowed_variance(parameters.noise.x, texture / float(used));
  return Consistency(score_of_variance(variance, allowed), 1.0 - 1.0 / float(used), used);
}

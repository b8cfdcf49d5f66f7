// Mean pairwise zero-mean normalised cross-correlation of the patches over the three channels
// [Hernandez04]; a noise floor keeps plain patches from correlating, and views far below the best are
// left out once. Confidence: texture variance, the mean over the views, a channel.
// Reference: carving::reference::photo_consistency.
const int kPairs = kViews * (kViews - 1) / 2;
const float kOutlierShare = 0.5;  // views whose agreement is below this share of the best are dropped,
const float kOutlierSlack = 0.1;  // but none that is this close to it

Consistency consistency(uint base, inout bool seen[kViews]) {
#ifdef SAMPLE_COVERAGE
  uint taps = common_taps(base, seen);
  float tap_count = float(max(bitCount(taps), 1));
#else
  const float tap_count = float(kPatchTaps);
#endif
  // Sums over the patch: of each view's colours, of their squares and of the views' products.
  vec3 sums[kViews];
  float squares[kViews];
  float products[kPairs];
  for (int i = 0; i < kViews; ++i) {
    sums[i] = vec3(0.0);
    squares[i] = 0.0;
  }
  for (int i = 0; i < kPairs; ++i) products[i] = 0.0;
  for (int row = 0; row < kPatchEdge; ++row)
    for (int at = 0; at < kPatchEdge; ++at) {
      vec3 x[kViews];
      for (int i = 0; i < kViews; ++i) {
        vec4 s = patch_tap(base, i, row * kPatchEdge + at);
        // Centred on mid-grey: the products then lose no precision.
        x[i] = s.rgb - 0.5;
#ifdef SAMPLE_COVERAGE
        x[i] = has_tap(taps, row * kPatchEdge + at) ? x[i] : vec3(0.0);
#else
        seen[i] = seen[i] && s.a >= 0.0;
#endif
        sums[i] += x[i];
        squares[i] += dot(x[i], x[i]);
      }
      for (int i = 1; i < kViews; ++i)
        for (int j = 0; j < i; ++j) products[i * (i - 1) / 2 + j] += dot(x[i], x[j]);
    }

  float scale[kViews];  // 1 / standard deviation with the noise floor; 0 for views that do not count
  float texture_variance = 0.0;
  int n = 0;
  for (int i = 0; i < kViews; ++i) {
    float variance = max(squares[i] - dot(sums[i], sums[i]) / tap_count, 0.0) / tap_count;
    scale[i] = seen[i] ? inversesqrt(variance + 3.0 * parameters.noise.x) : 0.0;
    texture_variance += seen[i] ? variance / 3.0 : 0.0;
    n += seen[i] ? 1 : 0;
  }
  float agreement[kViews];
  for (int i = 0; i < kViews; ++i) agreement[i] = 0.0;
  for (int i = 1; i < kViews; ++i)
    for (int j = 0; j < i; ++j) {
      int pair = i * (i - 1) / 2 + j;
      float covariance = (products[pair] - dot(sums[i], sums[j]) / tap_count) / tap_count;
      products[pair] = covariance * scale[i] * scale[j];
      agreement[i] += products[pair];
      agreement[j] += products[pair];
    }
  float best = -1e30;
  for (int i = 0; i < kViews; ++i) best = seen[i] ? max(best, agreement[i]) : best;
  float least = best - max((1.0 - kOutlierShare) * best, kOutlierSlack);
  bool kept[kViews];
  int used = 0;
  for (int i = 0; i < kViews; ++i) {
    kept[i] = seen[i] && agreement[i] >= least;
    used += kept[i] ? 1 : 0;
  }
  float score = 0.0;
  float pairs = 0.0;
  for (int i = 1; i < kViews; ++i)
    for (int j = 0; j < i; ++j) {
      float weight = kept[i] && kept[j] ? view_weights[i] * view_weights[j] : 0.0;
      score += weight * products[i * (i - 1) / 2 + j];
      pairs += weight;
    }
  score = used >= 2 ? score / pairs : -1.0;
#ifdef SAMPLE_COVERAGE
  if (bitCount(taps) < kLeastTaps) texture_variance = 0.0;
#endif
  return Consistency(score, texture_variance / float(max(n, 1)), used);
}

// Mean pairwise zero-mean normalised cross-correlation of the patches over the three channels
// [Hernandez04]; a noise floor keeps plain patches from correlating, and views far below the best are
// left out once. Confidence: texture variance, the mean over the views, a channel.
// Reference: carving::reference::photo_consistency.
const int kPairs = kViews * (kViews - 1) / 2;
const float kOutlierShare = 0.5;  // views whose agreement is below this share of the best are dropped,
const float kOutlierSlack = 0.1;  // but none that is this close to it

// Sums over the patch: of each view's colours, of their squares and of the views' products.
struct PatchSums {
  vec3 colours[kViews];
  float squares[kViews];
  float products[kPairs];
};

// What of the views' patches counts in a correlation.
struct PatchScales {
  float scale[kViews];     // 1 / standard deviation with the noise floor; 0 for views that do not count
  float texture_variance;  // mean over the views that count, a channel
};

// Where the products of two views lie, j < i.
int pair_of(int i, int j) { return i * (i - 1) / 2 + j; }

// Sums the taps that all views show. Views that the patch leaves do not count.
PatchSums sum_patches(uint base, uint taps, inout uint seen) {
  PatchSums sums;
  for (int i = 0; i < kViews; ++i) {
    sums.colours[i] = vec3(0.0);
    sums.squares[i] = 0.0;
  }
  for (int i = 0; i < kPairs; ++i) sums.products[i] = 0.0;
  for (int row = 0; row < kPatchEdge; ++row)
    for (int at = 0; at < kPatchEdge; ++at) {
      vec3 x[kViews];
      for (int i = 0; i < kViews; ++i) {
        vec4 s = patch_tap(base, i, row * kPatchEdge + at);
        // Centred on mid-grey: the products then lose no precision.
        x[i] = s.rgb - 0.5;
#ifdef SAMPLE_COVERAGE
        x[i] = has(taps, row * kPatchEdge + at) ? x[i] : vec3(0.0);
#else
        if (!(s.a >= 0.0)) seen &= ~(1u << uint(i));
#endif
        sums.colours[i] += x[i];
        sums.squares[i] += dot(x[i], x[i]);
      }
      for (int i = 1; i < kViews; ++i)
        for (int j = 0; j < i; ++j) sums.products[pair_of(i, j)] += dot(x[i], x[j]);
    }
  return sums;
}

// What brings each view's patch to unit variance, and how much texture the views show.
PatchScales scales_of(PatchSums sums, float tap_count, uint seen) {
  PatchScales s;
  s.texture_variance = 0.0;
  for (int i = 0; i < kViews; ++i) {
    float variance = max(sums.squares[i] - dot(sums.colours[i], sums.colours[i]) / tap_count, 0.0) / tap_count;
    s.scale[i] = has(seen, i) ? inversesqrt(variance + 3.0 * parameters.noise.x) : 0.0;
    s.texture_variance += has(seen, i) ? variance / 3.0 : 0.0;
  }
  s.texture_variance /= float(max(bitCount(seen), 1));
  return s;
}

// Makes correlations of the sums of products, and sums for each view those with all others.
void correlate(inout PatchSums sums, float scale[kViews], float tap_count, out float agreement[kViews]) {
  for (int i = 0; i < kViews; ++i) agreement[i] = 0.0;
  for (int i = 1; i < kViews; ++i)
    for (int j = 0; j < i; ++j) {
      int pair = pair_of(i, j);
      float covariance = (sums.products[pair] - dot(sums.colours[i], sums.colours[j]) / tap_count) / tap_count;
      sums.products[pair] = covariance * scale[i] * scale[j];
      agreement[i] += sums.products[pair];
      agreement[j] += sums.products[pair];
    }
}

// The views that do not agree far less with the others than the best one does; says how many.
int keep_agreeing(float agreement[kViews], uint seen, out uint kept) {
  float best = -1e30;
  for (int i = 0; i < kViews; ++i) best = has(seen, i) ? max(best, agreement[i]) : best;
  float least = best - max((1.0 - kOutlierShare) * best, kOutlierSlack);
  kept = 0u;
  for (int i = 0; i < kViews; ++i) kept |= has(seen, i) && agreement[i] >= least ? 1u << uint(i) : 0u;
  return bitCount(kept);
}

// Mean correlation of the pairs of kept views, weighted by how much of the voxel both see.
float mean_correlation(float correlations[kPairs], uint kept) {
  float score = 0.0;
  float pairs = 0.0;
  for (int i = 1; i < kViews; ++i)
    for (int j = 0; j < i; ++j) {
      float weight = has(kept, i) && has(kept, j) ? view_weights[i] * view_weights[j] : 0.0;
      score += weight * correlations[pair_of(i, j)];
      pairs += weight;
    }
  return score / pairs;
}

// The statistic of the voxel whose patches begin at `base`.
Consistency consistency(uint base, inout uint seen) {
#ifdef SAMPLE_COVERAGE
  uint taps = common_taps(base, seen);
  float tap_count = float(max(bitCount(taps), 1));
#else
  const uint taps = 0u;  // are not asked for: all count
  const float tap_count = float(kPatchTaps);
#endif
  PatchSums sums = sum_patches(base, taps, seen);
  PatchScales scales = scales_of(sums, tap_count, seen);
  float agreement[kViews];
  correlate(sums, scales.scale, tap_count, agreement);
  uint kept;
  int used = keep_agreeing(agreement, seen, kept);
  float score = mean_correlation(sums.products, kept);
#ifdef SAMPLE_COVERAGE
  if (bitCount(taps) < kLeastTaps) scales.texture_variance = 0.0;
#endif
  return Consistency(used >= 2 ? score : -1.0, scales.texture_variance, used);
}

// Variance with unknown gain: what is left of the patches when each is a multiple of one pattern, the
// best such pattern in the least-squares sense (the first singular vector). Confidence: what tells one
// pattern from another, contrast and hue, against the noise.
// Reference: carving::reference::gain_variance.
const int kPairs = kViews * (kViews + 1) / 2;
const int kPowerSteps = 16;

int gram_index(int i, int j) { return i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i; }

Consistency consistency(uint base, inout uint seen) {
  uint taps = common_taps(base, seen);
  int n = bitCount(seen);
  float tap_count = float(bitCount(taps));
  if (n < 2 || bitCount(taps) < kLeastTaps) return Consistency(-1.0, 0.0, n);
  float gram[kPairs];
  for (int i = 0; i < kPairs; ++i) gram[i] = 0.0;
  float contrast = 0.0;
  vec2 moments[kViews];
  for (int i = 0; i < kViews; ++i) moments[i] = vec2(0.0);
  for (int k = 0; k < kPatchTaps; ++k) {
    vec3 x[kViews];
    for (int i = 0; i < kViews; ++i) {
      x[i] = has(seen, i) && has(taps, k) ? patch_tap(base, i, k).rgb : vec3(0.0);
      moments[i] += vec2(dot(x[i], vec3(1.0)), dot(x[i], x[i]));
    }
    for (int i = 0; i < kViews; ++i)
      for (int j = 0; j <= i; ++j) gram[gram_index(i, j)] += dot(x[i], x[j]);
  }
  float trace = 0.0, values = 3.0 * tap_count;
  for (int i = 0; i < kViews; ++i) {
    trace += gram[gram_index(i, i)];
    contrast += max(moments[i].y - moments[i].x * moments[i].x / values, 0.0) / values;
  }
  contrast /= float(n);
  // The greatest eigenvalue of the views' products.
  float weight[kViews];
  for (int i = 0; i < kViews; ++i) weight[i] = has(seen, i) ? 1.0 : 0.0;
  float greatest = 0.0;
  for (int step = 0; step < kPowerSteps; ++step) {
    float next[kViews];
    float size = 0.0, product = 0.0, before = 0.0;
    for (int i = 0; i < kViews; ++i) {
      next[i] = 0.0;
      for (int j = 0; j < kViews; ++j) next[i] += gram[gram_index(i, j)] * weight[j];
      product += next[i] * weight[i];
      before += weight[i] * weight[i];
      size = max(size, next[i]);
    }
    greatest = before > 0.0 ? product / before : 0.0;
    for (int i = 0; i < kViews; ++i) weight[i] = size > 0.0 ? next[i] / size : 0.0;
  }
  float residual = max(trace - greatest, 0.0) / (float(n - 1) * (values - 1.0));
  float noise = parameters.noise.x;
  float confidence = contrast >= parameters.noise.z
                         ? (1.0 - 1.0 / float(n)) * contrast / (contrast + noise) : 0.0;
  return Consistency(score_of_variance(residual, allowed_variance(noise, contrast)), confidence, n);
}

// Histogram consistency [Stevens02]: how much the histograms of the views' patches intersect, eight bins
// a channel, each value shared between the two bins nearest to it; the mean over pairs and channels,
// from -1 where they are apart to 1 where they are alike. Where each colour lies does not matter, so it
// bears misregistration. Confidence: contrast against the noise.
// Reference: carving::reference::histogram_consistency.
const int kBins = 8;

Consistency consistency(uint base, inout uint seen) {
  uint taps = common_taps(base, seen);
  int n = bitCount(seen);
  if (n < 2 || bitCount(taps) < kLeastTaps) return Consistency(-1.0, 0.0, n);
  vec3 histogram[kViews * kBins];
  float texture = 0.0;
  for (int i = 0; i < kViews; ++i) {
    for (int b = 0; b < kBins; ++b) histogram[i * kBins + b] = vec3(0.0);
    if (!has(seen, i)) continue;
    texture += patch_texture(base, i, taps) / float(n);
    for (int k = 0; k < kPatchTaps; ++k) {
      if (!has(taps, k)) continue;
      vec3 place = clamp(patch_tap(base, i, k).rgb, 0.0, 1.0) * float(kBins - 1);
      for (int b = 0; b < kBins; ++b)
        histogram[i * kBins + b] += max(1.0 - abs(place - float(b)), 0.0);
    }
  }
  float shared_taps = 0.0;
  for (int i = 1; i < kViews; ++i)
    for (int j = 0; j < i; ++j)
      for (int b = 0; b < kBins; ++b)
        shared_taps += has(seen, i) && has(seen, j)
            ? dot(min(histogram[i * kBins + b], histogram[j * kBins + b]), vec3(1.0)) : 0.0;
  float pairs = 0.5 * float(n * (n - 1));
  float intersection = shared_taps / (3.0 * pairs * float(bitCount(taps)));
  float noise = parameters.noise.x;
  float confidence = texture >= parameters.noise.z ? (1.0 - 1.0 / float(n)) * texture / (texture + noise) : 0.0;
  return Consistency(2.0 * intersection - 1.0, confidence, n);
}

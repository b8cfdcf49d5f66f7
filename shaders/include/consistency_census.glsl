// Census [ZabihWoodfill94]: each tap is brighter than the patch's middle, darker, or equal within the
// noise; the share of the informative taps on which pairs of views agree. Bears any monotone change of
// brightness. Confidence: from the number of views and the share of the taps that inform.
// Reference: carving::reference::census.
const float kTolerance = 2.4494897;      // noise of a difference of sums of three channels, in sigmas
const float kLeastInformative = 0.25;    // of the taps
const float kCensusGain = 1.4;           // a similarity of a half counts as agreement (0.7)

Consistency consistency(uint base, inout uint seen) {
  uint taps = common_taps(base, seen);
  int n = bitCount(seen);
  if (n < 2 || bitCount(taps) < kLeastTaps) return Consistency(-1.0, 0.0, n);
  float tolerance = kTolerance * sqrt(parameters.noise.x);
  float middle[kViews];
  for (int i = 0; i < kViews; ++i) middle[i] = dot(patch_tap(base, i, kPatchTaps / 2).rgb, vec3(1.0));
  int differing = 0, informative = 0;
  for (int k = 0; k < kPatchTaps; ++k) {
    if (k == kPatchTaps / 2 || !has(taps, k)) continue;
    int digit[kViews];
    for (int i = 0; i < kViews; ++i) {
      float d = dot(patch_tap(base, i, k).rgb, vec3(1.0)) - middle[i];
      digit[i] = d > tolerance ? 1 : d < -tolerance ? -1 : 0;
    }
    for (int i = 1; i < kViews; ++i)
      for (int j = 0; j < i; ++j) {
        bool pair = has(seen, i) && has(seen, j) && (digit[i] != 0 || digit[j] != 0);
        informative += pair ? 1 : 0;
        differing += pair ? abs(digit[i] - digit[j]) : 0;
      }
  }
  float pairs = 0.5 * float(n * (n - 1));
  float share = float(informative) / (pairs * float(bitCount(taps) - 1));
  float similarity = 1.0 - float(differing) / float(max(informative, 1));
  float confidence = share >= kLeastInformative ? (1.0 - 1.0 / float(n)) * min(share, 1.0) : 0.0;
  return Consistency(similarity > 0.0 ? min(kCensusGain * similarity, 1.0) : similarity, confidence, n);
}

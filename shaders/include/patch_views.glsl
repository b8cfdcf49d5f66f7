// The patches around a voxel on the reference plane as the sweep's views show them: square roots of
// linear light, which makes the noise even. Statistics of consistency read them here and give a
// Consistency.
layout(std430, binding = kSweepSamplesBinding) readonly buffer Samples { vec4 samples[]; };

#include "include/search_disc.glsl"

const int kViews = kMaxLayerViews;
const int kPatchEdge = 2 * kPatchRadius + 1;
const int kPatchTaps = kPatchEdge * kPatchEdge;
const int kLeastTaps = (kPatchTaps + 1) / 2;

// How much of the voxel each view sees, which weighs pairs of views; 1 unless visibility is filtered.
float view_weights[kViews];

#if SEARCH_TAPS > 1
// Which of the search offsets each view's patch is taken at.
int view_shifts[kViews];
#endif

struct Consistency {
  float score;       // at most 1; from thresholds.x on the views agree; -1 below two views
  float confidence;  // evidence behind it; below noise.y there is too little to say anything
  int used;          // views that the score is of
};

// `base`: where the voxel's patch begins in the first view's samples.
vec4 patch_tap(uint base, int view, int k) {
#if SEARCH_TAPS > 1
  int area = view * SEARCH_TAPS + view_shifts[view];
#else
  int area = view;
#endif
  return samples[base + uint(area * kApronArea + k / kPatchEdge * kApronEdge + k % kPatchEdge)];
}

// Sets of taps and of views are bits of a number: some drivers (Zink of Mesa 22) take no arrays of bool.
bool has(uint set, int k) { return (set >> uint(k) & 1u) != 0u; }

// Taps, as bits, that all views show. Views that the patch leaves, that show background in its middle
// or in more than half of it, do not count.
uint common_taps(uint base, inout uint seen) {
  uint common_bits = (1u << uint(kPatchTaps)) - 1u;
  for (int i = 0; i < kViews; ++i) {
    uint shown = 0u;
    bool whole = true;
    for (int k = 0; k < kPatchTaps; ++k) {
      float a = patch_tap(base, i, k).a;
      whole = whole && a >= 0.0;
      shown |= a > 0.0 ? 1u << uint(k) : 0u;
    }
    if (!(whole && has(shown, kPatchTaps / 2) && bitCount(shown) >= kLeastTaps)) seen &= ~(1u << uint(i));
    common_bits = has(seen, i) ? common_bits & shown : common_bits;
  }
  return common_bits;
}

// Residuals that count as agreement: beyond noise, what resampling and a place not quite on the
// surface make of texture.
float allowed_variance(float noise_variance, float texture) { return 4.0 * noise_variance + 0.25 * texture; }

// A residual variance as a score: 1 without any, 0.7 where it is as large as is allowed.
float score_of_variance(float variance, float allowed) { return max(1.0 - 0.3 * variance / allowed, -1.0); }

// Variance of a view's patch, a channel, about each channel's mean.
float patch_texture(uint base, int view, uint taps) {
  vec3 sum = vec3(0.0);
  float squares = 0.0;
  for (int k = 0; k < kPatchTaps; ++k) {
    vec3 x = has(taps, k) ? patch_tap(base, view, k).rgb - 0.5 : vec3(0.0);
    sum += x;
    squares += dot(x, x);
  }
  float count = float(bitCount(taps));
  return max(squares - dot(sum, sum) / count, 0.0) / (3.0 * count);
}

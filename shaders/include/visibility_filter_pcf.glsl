// Percentage-closer filtering [Reeves87]: the weighted share of FILTER_SIZE^2 tests that pass. Kernels
// on texels, or with PCF_ON_PIXELS on the receiver's neighbours; regular, jittered or circular
// (equation 10 of [BarrosoCeles07]); PCF_GAUSSIAN weights; PCF_ADAPTIVE takes the outer tests first and is
// done where they agree [Uralsky05]. Reference: visibility::reference::Map::pcf.
#if !defined(FILTER_SIZE)
#define FILTER_SIZE 3
#endif
const int kTaps = FILTER_SIZE;

uint hash(uint x) {
  x = (x ^ (x >> 16u)) * 0x7feb352du;
  x = (x ^ (x >> 15u)) * 0x846ca68bu;
  return x ^ (x >> 16u);
}

// In [-0.5, 0.5), the same wherever a position lies within a sixteenth of a texel.
vec2 jitter_of(vec2 at, int tap) {
  uvec2 cell = uvec2(ivec2(floor(at * 16.0)));
  uint h = hash(cell.x ^ hash(cell.y ^ hash(uint(tap))));
  return vec2(float(h & 0xffffu), float(h >> 16u)) / 65536.0 - 0.5;
}

// Of tap (i, j), in texels or pixels.
vec2 tap_offset(vec2 at, int i, int j) {
  vec2 cell = vec2(i, j) + 0.5;
#if defined(PCF_JITTERED) || defined(PCF_CIRCULAR_JITTERED)
  cell += jitter_of(at, j * kTaps + i);
#endif
#if defined(PCF_CIRCULAR) || defined(PCF_CIRCULAR_JITTERED)
  float radius = 0.5 * float(kTaps) * sqrt(max(cell.y, 0.0) / float(kTaps));
  float turn = 6.28318530718 * cell.x / float(kTaps);
  return radius * vec2(cos(turn), sin(turn));
#else
  return cell - 0.5 * float(kTaps);
#endif
}

float tap_weight(vec2 offset) {
#if defined(PCF_GAUSSIAN)
  float sigma = 0.25 * float(kTaps);
  return exp(-0.5 * dot(offset, offset) / (sigma * sigma));
#else
  return 1.0;
#endif
}

#if defined(PCF_CIRCULAR) || defined(PCF_CIRCULAR_JITTERED)
const int kOuterTaps = kTaps;
#else
const int kOuterTaps = 4 * (kTaps - 1);
#endif

// The k-th tap, those of the rim or of the outermost circle first.
ivec2 from_outside(int k) {
#if defined(PCF_CIRCULAR) || defined(PCF_CIRCULAR_JITTERED)
  return ivec2(k % kTaps, kTaps - 1 - k / kTaps);
#else
  const int last = kTaps - 1, within = max(kTaps - 2, 1);
  if (k >= kOuterTaps) return 1 + ivec2((k - kOuterTaps) % within, (k - kOuterTaps) / within);
  int side = k / last, along = k - side * last;
  ivec2 at = (side & 1) == 0 ? ivec2(along, 0) : ivec2(last, along);
  return side < 2 ? at : last - at;
#endif
}

vec2 tap_position(Receiver r, MapPoint m, vec2 offset) {
#if defined(PCF_ON_PIXELS)
  vec3 beside = r.position.xyz + offset.x * r.step_x.xyz + offset.y * r.step_y.xyz;
  return locate(m.part, beside).at;
#else
  return m.at + offset;
#endif
}

void add_tap(Receiver r, vec2 prepared, MapPoint m, ivec2 tap, inout float passed, inout float weight) {
  vec2 offset = tap_offset(m.at, tap.x, tap.y);
  float w = tap_weight(offset);
  weight += w;
  if (lit(r, prepared, m, tap_position(r, m, offset))) passed += w;
}

float fraction_visible(Receiver r, MapPoint m) {
  vec2 prepared = prepare(r, m);
  float passed = 0.0, weight = 0.0;
#if defined(PCF_ADAPTIVE)
  // One loop, for software devices leave loops early but run both sides of a branch.
  int k = 0;
  bool agreed;
  do {
    add_tap(r, prepared, m, from_outside(k), passed, weight);
    ++k;
    agreed = k == kOuterTaps && (passed == 0.0 || passed == weight);
  } while (k < kTaps * kTaps && !agreed);
#else
  for (int j = 0; j < kTaps; ++j)
    for (int i = 0; i < kTaps; ++i) add_tap(r, prepared, m, ivec2(i, j), passed, weight);
#endif
  return passed == weight ? 1.0 : passed / weight;  // not every device divides exactly
}

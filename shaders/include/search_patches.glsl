// r-consistency [Kutulakos00]: of the patches that a view shows within the search disc, it takes the
// one that correlates best with the mean of the other views' chosen patches; view after view,
// kSearchRounds times. Patches are normalised first, so that no view dominates the mean.
// Reference: carving::reference::choose_shifts.
struct SearchedPatch {
  float scale;        // 1 / norm of the centred patch, with the noise floor; 0: does not count
  vec3 mean;          // of its colours
  float correlation;  // with the mean of the others, times that one's norm
};

bool tap_shows(vec4 s) {
#ifdef SAMPLE_COVERAGE
  return s.a > 0.0;
#else
  return true;
#endif
}

// Of the view's patch at its present shift, against `pattern`.
SearchedPatch search_patch(uint base, int view, vec3 pattern[kPatchTaps]) {
  vec3 sum = vec3(0.0), pattern_sum = vec3(0.0);
  float squares = 0.0, product = 0.0;
  int shown = 0;
  bool whole = true;
  for (int k = 0; k < kPatchTaps; ++k) {
    vec4 s = patch_tap(base, view, k);
    whole = whole && s.a >= 0.0 && (k != kPatchTaps / 2 || tap_shows(s));
    if (!tap_shows(s)) continue;
    vec3 x = s.rgb - 0.5;
    sum += x;
    squares += dot(x, x);
    product += dot(x, pattern[k]);
    pattern_sum += pattern[k];
    ++shown;
  }
  float count = float(max(shown, 1));
  float centred = max(squares - dot(sum, sum) / count, 0.0);
  SearchedPatch p;
  p.mean = sum / count + 0.5;
  p.scale = whole && shown >= kLeastTaps ? inversesqrt(centred + 3.0 * count * parameters.noise.x) : 0.0;
  p.correlation = (product - dot(sum, pattern_sum) / count) * p.scale;
  return p;
}

// Adds `sign` times the view's normalised patch to the pattern.
void add_patch(uint base, int view, SearchedPatch p, float sign, inout vec3 pattern[kPatchTaps]) {
  for (int k = 0; k < kPatchTaps; ++k) {
    vec4 s = patch_tap(base, view, k);
    pattern[k] += tap_shows(s) ? sign * p.scale * (s.rgb - p.mean) : vec3(0.0);
  }
}

// Sets view_shifts; views that nowhere in their disc show the patch no longer count.
void choose_shifts(uint base, inout uint seen) {
  vec3 pattern[kPatchTaps];
  for (int k = 0; k < kPatchTaps; ++k) pattern[k] = vec3(0.0);
  for (int i = 0; i < kViews; ++i) {
    view_shifts[i] = 0;
    if (!has(seen, i)) continue;
    SearchedPatch p = search_patch(base, i, pattern);
    while (p.scale == 0.0 && view_shifts[i] < SEARCH_TAPS - 1) {
      ++view_shifts[i];
      p = search_patch(base, i, pattern);
    }
    if (!(p.scale > 0.0)) seen &= ~(1u << uint(i));
    else add_patch(base, i, p, 1.0, pattern);
  }
  for (int at = 0; at < kSearchRounds * kViews; ++at) {
    int i = at % kViews;
    if (!has(seen, i)) continue;
    add_patch(base, i, search_patch(base, i, pattern), -1.0, pattern);
    SearchedPatch best = search_patch(base, i, pattern);
    int chosen = view_shifts[i];
    for (int shift = 0; shift < SEARCH_TAPS; ++shift) {
      view_shifts[i] = shift;
      SearchedPatch p = search_patch(base, i, pattern);
      if (p.scale > 0.0 && p.correlation > best.correlation) {
        best = p;
        chosen = shift;
      }
    }
    view_shifts[i] = chosen;
    add_patch(base, i, best, 1.0, pattern);
  }
}

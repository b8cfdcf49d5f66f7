// Signals of results in order, for tests to spoil, and what is to be said of them.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "assess/verdict.h"

namespace photohull::assess {

/// Of a view whose pixels are a hundredth of a world unit.
inline ViewResidual residual(double pixels, int matches) {
  return {.pixels = pixels, .matches = matches, .pixel_size = 0.01};
}

/// Twenty views of a textured object, all in order.
inline Signals in_order() {
  Signals s;
  s.views = 20;
  s.masks = true;
  s.mask_confidence = 1;
  s.pixel_size = 0.01;
  s.far = 0.01;  // half a percent of the diagonal is a pixel
  s.mean_confidence = 0.95;
  s.unsure = 0.03, s.unseen = 0.02, s.few_views = 0.05;
  s.match.seen = 0.95, s.match.textured = 0.9, s.match.matched = 0.9;
  s.match.residual = 0.1;
  s.match.pixel_size = 0.01;
  s.match.views.assign(20, residual(0.1, 50));
  return s;
}

inline std::vector<std::string> names() {
  std::vector<std::string> names;
  for (int i = 0; i < 20; ++i) names.push_back("view" + std::to_string(i));
  return names;
}

inline Verdict judged(const Signals& s) { return judge(s, names()); }

/// Of a result that is in order but for what `change` does.
inline Verdict with(auto&& change) {
  Signals s = in_order();
  change(s);
  return judged(s);
}

inline void expect(const Verdict& v, Level level, const char* reason) {
  EXPECT_EQ(v.level, level);
  EXPECT_THAT(v.reasons, testing::ElementsAre(testing::HasSubstr(reason)));
}

/// Twenty views without silhouettes, each with places of these kinds.
inline Signals without_silhouettes(const std::map<Place, int>& places) {
  Signals s = in_order();
  s.masks = false;
  for (int v = 0; v < 20; ++v) {
    ExplainedView& view = s.explained.views.emplace_back();
    for (const auto& [place, count] : places) {
      s.explained.counts[std::size_t(place)] += count;
      view.places.insert(view.places.end(), std::size_t(count), PlaceAt{0, 0, place});
    }
  }
  return s;
}

}  // namespace photohull::assess

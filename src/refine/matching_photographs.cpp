#include "refine/matching_photographs.h"

namespace photohull::refine {

HeldNumbers::HeldNumbers(std::span<const int> views, std::size_t count) : places_(count, -1) {
  for (std::size_t k = 0; k < views.size(); ++k) places_[std::size_t(views[k])] = int(k);
}

ViewChoice HeldNumbers::of(ViewChoice choice) const {
  if (places_.empty()) return choice;
  ViewList<ViewChoice::kMostViews> views;
  for (const int view : choice.views) views.push_back(places_[std::size_t(view)]);
  choice.views = views;
  return choice;
}

}  // namespace photohull::refine

#include "refine/matching_photographs.h"

namespace photohull::refine {

ViewChoice HeldNumbers::of(ViewChoice choice) const {
  if (layers_.empty()) return choice;
  ViewList<ViewChoice::kMostViews> views;
  for (const int view : choice.views) views.push_back(layers_[std::size_t(view)]);
  choice.views = views;
  return choice;
}

}  // namespace photohull::refine

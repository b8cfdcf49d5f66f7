// The photographs that surfels are matched in: all at once, or a few at a time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "projtex/out_of_core.h"
#include "projtex/photographs.h"
#include "refine/view_choice.h"
#include "refine/view_groups.h"

namespace photohull::refine {

/// Where views lie among the photographs that are held.
class HeldNumbers {
 public:
  /// All are held, in their order.
  HeldNumbers() = default;
  /// `layers`: by view, as HeldPhotographs has them.
  explicit HeldNumbers(std::span<const int> layers) : layers_(layers.begin(), layers.end()) {}

  /// The same views in the numbers of what is held; `hidden` stays.
  ViewChoice of(ViewChoice choice) const;

 private:
  std::vector<int> layers_;
};

/// What it refers to outlives it.
class MatchingPhotographs {
 public:
  /// All of them are on the device.
  MatchingPhotographs(const projtex::ImageSet& images, std::span<const Camera> cameras,
                      double noise_sigma)
      : images_(&images), cameras_(cameras), noise_sigma_(noise_sigma) {}
  explicit MatchingPhotographs(projtex::OutOfCorePhotographs& some)
      : some_(&some), cameras_(some.cameras()), noise_sigma_(some.noise_sigma()) {}

  std::span<const Camera> cameras() const { return cameras_; }

  /// Calls work(photographs, surfels, numbers) such that every comparable surfel is in the list of
  /// one call, in rising order, and its views are among that call's photographs, by `numbers`.
  template <typename Work>
  void for_each(std::span<const ViewChoice> choices, const Work& work) const {
    if (images_) {
      const std::vector<std::uint32_t> all = comparable(choices);
      work(projtex::Photographs{*images_, cameras_, noise_sigma_}, std::span(all), HeldNumbers());
      return;
    }
    for (const ViewGroup& group : group_by_views(choices, int(cameras_.size()), some_->most())) {
      const projtex::HeldPhotographs& held = some_->hold(group.views);
      work(projtex::Photographs{held.images, held.cameras, noise_sigma_}, std::span(group.surfels),
           HeldNumbers(held.layers));
    }
  }

 private:
  const projtex::ImageSet* images_ = nullptr;
  projtex::OutOfCorePhotographs* some_ = nullptr;
  std::span<const Camera> cameras_;
  double noise_sigma_;
};

}  // namespace photohull::refine

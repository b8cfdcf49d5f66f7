// As many photographs on the device as there is room for.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"
#include "core/prepared_view.h"
#include "projtex/out_of_core.h"

namespace photohull::projtex {

/// Those that were not asked for the longest make room for others.
class PhotographCache {
 public:
  /// Room for `layers` of the photographs that the cameras took. The texture is as large as for all
  /// of them: what is sampled does not depend on which are held. `cut_at`: as array_size has it.
  /// Throws Error when the device cannot hold it.
  PhotographCache(std::span<const Camera> cameras, int layers, ColourImage::Encoding encoding,
                  int cut_at = 1);

  /// Which of these, of which there is room for all, have to be put; the others stay until then.
  std::vector<int> missing(std::span<const int> numbers);
  void put(int number, const PreparedView& view);
  /// `sharpness` as ImageSet::sharpness has it.
  void put(int number, const ColourImage& image, double sharpness);
  const HeldPhotographs& held() const { return held_; }

 private:
  /// In place of the one that was not asked for the longest.
  int make_room(int number);

  std::vector<Camera> cameras_;  // of all photographs
  HeldPhotographs held_;
  std::vector<std::int64_t> used_;  // by layer: the turn in which it was asked for
  std::int64_t turn_ = 0;
};

}  // namespace photohull::projtex

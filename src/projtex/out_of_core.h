// Photographs that do not fit into memory together.
#pragma once

#include <span>
#include <vector>

#include "core/camera.h"
#include "projtex/image_set.h"

namespace photohull::projtex {

/// Some photographs on the device.
struct HeldPhotographs {
  ImageSet images;              ///< in no order; there may be layers that hold none
  std::vector<Camera> cameras;  ///< one a layer
  std::vector<int> layers;      ///< of every photograph, by its number; -1: it is not held
};

/// Photographs of which the device holds a few at a time. Who needs all of them works part by part.
class OutOfCorePhotographs {
 public:
  virtual ~OutOfCorePhotographs() = default;

  /// Of all of them, in a fixed order.
  virtual std::span<const Camera> cameras() const = 0;
  /// Standard deviation, square roots of linear light.
  virtual double noise_sigma() const = 0;
  /// How many are held at once.
  virtual int most() const = 0;
  /// Those with these numbers, most() at most. What was held before goes where there is no room for
  /// both, what was not asked for the longest first. Throws Error where one cannot be read or the
  /// device cannot hold them, Cancelled.
  virtual const HeldPhotographs& hold(std::span<const int> numbers) = 0;
};

}  // namespace photohull::projtex

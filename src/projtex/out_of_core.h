// Photographs that do not fit into memory together.
#pragma once

#include <span>
#include <vector>

#include "core/camera.h"
#include "projtex/image_set.h"

namespace photohull::projtex {

/// Some photographs on the device.
struct HeldPhotographs {
  ImageSet images;
  std::vector<Camera> cameras;  ///< one an image
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
  /// Those with these numbers, in this order; what was held before goes. Throws Error where one
  /// cannot be read or the device cannot hold them, Cancelled.
  virtual const HeldPhotographs& hold(std::span<const int> numbers) = 0;
};

}  // namespace photohull::projtex

// Do photographs differ in exposure or colour at all? A quick look before gains are solved for.
#pragma once

#include <vector>

#include "views/photometric.h"

namespace photohull {

struct PhotometricCheckOptions {
  int least_samples = 12;          ///< of a view in each half; with fewer it says nothing. >= 3
  double least_sigmas = 3;         ///< of the gains, in the deviation of their own estimate. >= 0
  double least_vignetting = 0.04;  ///< less is held to be none: shading and surface feign it. >= 0
  double least_profit = 0.025;     ///< by which the other half's colours agree better. In [0, 1)

  /// Throws UsageError naming the field.
  void validate() const;
};

struct PhotometricCheck {
  int points = 0, samples = 0;
  int views = 0;        ///< whose gains both halves tell
  double rms_gain = 0;  ///< of the gains' logarithms over views and channels, less their noise
  double noise = 0;     ///< standard deviation of these logarithms' estimate
  /// Share by which the median disagreement of a half's colours falls with the other half's gains.
  double profit = 0;
  double vignetting = 0;        ///< of all lenses together: share of the light lost in the corners
  double vignetting_noise = 0;  ///< standard deviation of it, from eight groups of points
  bool differ = false;          ///< gains or vignetting exceed their noise, and pay
};

/// Estimates the views' gains twice, on two halves of the points, by medians in turn over views and
/// over points; clusters of points go to one half as a whole, since errors of surface and shading
/// go together. What both halves find alike is the gains (the mean product of the two estimates),
/// what they find otherwise is the noise of the estimate (half their difference), measured on the
/// scene itself. `view_count` > 0; samples as sample_photometric gives them. Vignetting is the
/// slope of what is left over the squared radius, in each half.
PhotometricCheck check_photometric(const std::vector<PhotometricPoint>& points, int view_count,
                                   const PhotometricCheckOptions& options = {});

}  // namespace photohull

// Gains, white balance and vignetting of the views, from surface points that several of them see.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "core/progress.h"

namespace photohull {

/// A surface point as one view shows it.
struct PhotometricSample {
  int view = 0;
  double radius2 = 0;      ///< squared distance from the frame's middle; 1 in its corners
  glm::dvec3 colour{0.0};  ///< linear light, the mean over a window, > 0
  glm::dvec3 sigma{0.02};  ///< expected deviation of the colour's logarithm, > 0
};

struct PhotometricPoint {
  int cluster = 0;  ///< >= 0; errors of points in one cluster may go together
  std::vector<PhotometricSample> samples;
};

struct PhotometricOptions {
  int least_samples = 40;     ///< of a view; with fewer its gain stays 1. In [3, 1e6]
  double held_out = 0.2;      ///< share of the points that only judges. In [0.05, 0.5]
  double least_gain = 0.005;  ///< rms of the gains' logarithms that is worth a correction. >= 0
  double least_vignetting = 0.04;  ///< less is held to be none: shading and surface feign it. >= 0
  double least_sigmas = 3;         ///< rms of the gains in their standard deviations. >= 0
  double least_profit = 0.05;  ///< share by which the held-out disagreement must fall. In [0, 1)

  /// Throws UsageError naming the field.
  void validate() const;
};

/// What a view does to light: it records gain * (1 - vignetting * r^2) times what arrives.
struct ViewGain {
  glm::dvec3 gain{1.0};   ///< of red, green and blue
  glm::dvec3 sigma{0.0};  ///< standard deviation of the gain's logarithm; 0 where not solved
  int samples = 0;
  bool solved = false;  ///< false: too few samples, or no connection to the other views
};

struct PhotometricCalibration {
  std::vector<ViewGain> views;
  int lens_count = 0;
  std::vector<double> vignetting;        ///< of each lens: share of the light lost in the corners
  std::vector<double> vignetting_sigma;  ///< of each lens; 0 where vignetting is not determined
  int points = 0, samples = 0;           ///< that the solution used
  int held_out_samples = 0;
  /// Median deviation, relative, of a held-out point's colour in a view from its usual colour.
  double disagreement_before = 0, disagreement_after = 0;
  double rms_gain = 0;    ///< of the gains' logarithms over solved views and channels
  double rms_sigmas = 0;  ///< of the same in their standard deviations
  bool solved = false;    ///< at least two views
  bool significant = false;
  bool pays = false;  ///< significant, and the held-out points agree better
};

/// Solves log colour = log gain(view) + log(1 - v(lens) r^2) + log albedo(point) by Ceres with a
/// Cauchy loss whose width follows the residuals. Gauge: the geometric mean of the gains of solved
/// views is 1 in each channel. Standard deviations come from the sandwich covariance [Liang86]
/// with the points' clusters: errors of surface and shading are alike over a cluster. A lens's
/// vignetting is held at 0 where it is within three deviations of it or below `least_vignetting`.
///
/// `lens_of_view` says which views share a lens, numbers from 0. Points with samples in one view
/// only say nothing. With too little evidence `solved` is false and all gains are 1. Equal input
/// gives equal output, whatever the number of threads. Throws Cancelled.
PhotometricCalibration calibrate_photometric(const std::vector<PhotometricPoint>& points,
                                             const std::vector<int>& lens_of_view,
                                             const PhotometricOptions& options,
                                             const Progress& progress);

}  // namespace photohull

// What the stages of a job take of its time, for the progress bar.
#pragma once

namespace photohull::pipeline {

struct ReconstructOptions;

/// Shares of a job's time: tenths of a wall second of templeRing's stages on two cores (`photohull
/// reconstruct templeRing --json`). They only drive the progress bar's time left.
struct Weights {
  static constexpr double kScene = 0.1, kViews = 3, kCameras = 100, kLookAtCameras = 0.5,
                          kDevice = 0.5, kSilhouettes = 2.5, kHull = 1, kImages = 2, kPhoto = 110,
                          kRefine = 50, kClean = 0.2, kMesh = 0.6, kPhotometric = 1, kColour = 2,
                          kVerdict = 3, kSurroundings = 10, kSimplify = 15, kPage = 2,
                          kTexture = 40, kPreview = 2.7, kVolume = 1, kFiles = 1;
  /// Of refining the cameras; by default only their agreement is looked at, unless that is bad.
  static double cameras(const ReconstructOptions& options);
};

/// Sum of the weights of the stages that this job will announce to its Progress.
double total_weight(const ReconstructOptions& options);

}  // namespace photohull::pipeline

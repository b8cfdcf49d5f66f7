// How well and how fast the samplers resample, measured on the device.
#pragma once

#include <string>
#include <vector>

#include "core/describe.h"
#include "core/progress.h"
#include "gpu/context.h"
#include "projtex/sampler.h"

namespace photohull::projtex {

struct StudyOptions {
  /// Root of the area of a square's projection, pixels: 0.25 is magnification by 4.
  std::vector<double> footprints{0.25, 0.5, 1, 2, 4, 8, 16, 32};
  std::vector<double> ratios{1, 2, 4, 8, 16};  ///< of a footprint's long axis to its short one
  std::vector<int> supersamples{1, 2, 4, 8};
  int squares = 256;  ///< in each of two images, white noise and zones up to the Nyquist frequency
  int repeats = 7;    ///< that timings are taken, of which the quickest counts
  unsigned seed = 1;

  void validate() const;  ///< throws UsageError
};

/// Those that a caller chooses for the time that the study takes.
void describe(Described& to, StudyOptions& options);

/// One sampler at one kind of footprint.
struct StudyCell {
  Sampler sampler{};
  int supersample = 1;
  double footprint = 0, ratio = 0;
  /// Of the differences to the oracle (sampler_reference.h) in linear light, percent of full scale.
  double rms = 0, percentile99 = 0;
  double nanoseconds =
      0;  ///< a square; processor time of all threads on software devices, else wall time
};

/// All samplers that the device has, at all footprints. Squares lie on tilted planes before
/// perspective cameras, turned at random.
std::vector<StudyCell> study_samplers(gpu::Context& context, const StudyOptions& options,
                                      Progress& progress);

/// A kernel of the sweep on bricks of voxels.
struct SweepRate {
  std::string name;
  double pixels = 0;       ///< that a voxel's edge spans
  double nanoseconds = 0;  ///< a sample, as StudyCell has them
  double share_of_raw =
      0;  ///< of the rate of a bare loop of such fetches; 0 where there is none to compare
};

/// The sweep's kernels with every sampler at voxels of a pixel, and beside bare loops of texture
/// fetches.
std::vector<SweepRate> measure_sweeps(gpu::Context& context, int repeats, Progress& progress);

}  // namespace photohull::projtex

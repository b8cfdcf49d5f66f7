// Results of the same rig that were made before: cameras, gains and a surface for the next one.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/prepared_view.h"
#include "core/progress.h"
#include "pipeline/findings.h"
#include "pipeline/part.h"
#include "pipeline/reconstruct_options.h"
#include "refine/follow.h"
#include "views/photometric.h"

namespace photohull::pipeline {

/// Of the photographs, by a measurement or an earlier result.
struct MeasuredGains {
  PhotometricFindings findings;
  std::optional<PhotometricCalibration> gains;  ///< where pixels are to be divided by them
};

struct ResultRig {
  std::filesystem::path folder;
  std::vector<CameraPose> cameras;  ///< as they took effect, of the photographs as they were read
  std::string photometric;          ///< JSON (pipeline/photometric.h); empty: not asked for
};

struct EarlierResults {
  std::optional<ResultRig> rig;
  std::optional<refine::MomentBefore> before;
  std::optional<Part> part;  ///< of the whole
  VerdictFindings verdict;   ///< of the whole

  const ResultRig* given_rig() const { return rig ? &*rig : nullptr; }
  const Part* given_part() const { return part ? &*part : nullptr; }
  const refine::MomentBefore* given_moment() const { return before ? &*before : nullptr; }
};

/// What the options ask for. Throws Error where a folder does not hold it.
EarlierResults read_earlier(const ReconstructOptions& options);

/// Throws Error where the folder holds no result.
ResultRig read_rig(const std::filesystem::path& folder);

/// What another run with the rig goes by: alike where cameras and gains are.
std::string digest_of(const ResultRig& rig);

/// The views with the rig's cameras. Warns of views that it has not; these keep their own. Throws
/// Error where a photograph has other proportions there.
std::vector<PreparedView> with_cameras_of(const ResultRig& rig, std::vector<PreparedView> views,
                                          Progress& progress);

/// The rig's gains for these views; 1 for those that it has not. Throws Error where the folder's
/// report is damaged.
MeasuredGains gains_of(const ResultRig& rig, const std::vector<PreparedView>& views);

}  // namespace photohull::pipeline

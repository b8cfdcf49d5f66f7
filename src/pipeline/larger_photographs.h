// Photographs that are matched larger than memory holds all of them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/prepared_view.h"
#include "core/progress.h"
#include "pipeline/photographs.h"
#include "pipeline/reconstruct_options.h"
#include "pipeline/subject.h"
#include "projtex/out_of_core.h"
#include "views/photometric.h"

namespace photohull::pipeline {

/// How few photographs, of `views` in all, a surface can be matched in part by part.
int fewest_held(std::size_t views);

/// Bytes that `count` held photographs of so many pixels take, mip levels among them, and decoding
/// files of `decoded` pixels.
std::int64_t held_bytes(int count, double pixels, double decoded);

/// Can as few as are needed of so many pixels, of `views` in all, be held in one texture?
bool can_be_held(std::size_t views, double pixels);

/// Bytes of as few as are needed, at the scales that the views are matched at.
std::int64_t fewest_held_bytes(std::span<const PreparedView> views);

/// The views' cameras at the scales that they are matched at.
std::vector<Camera> matched_cameras(std::span<const PreparedView> views);

/// The subject's photographs at the scales that they are matched at, read again whenever they are
/// asked for: undistorted, cropped and divided by `gains` as its views are. A file without a name
/// in options.checkpoint, if there is such a folder and much room in it, keeps them for the next
/// time. Notes how many are held. Null where the views are as large, and, with a warning, where no
/// texture can hold as few as are needed. Throws Error where a photograph cannot be read any more.
/// Reader and progress outlive the result.
std::unique_ptr<projtex::OutOfCorePhotographs> larger_photographs(
    const PhotographReader& reader, const Subject& subject,
    const std::optional<PhotometricCalibration>& gains, const ReconstructOptions& options,
    Progress& progress);

}  // namespace photohull::pipeline

// Tracks with what tells them from others. Internal to cameras; only for files that know OpenCV.
#pragma once

#include <opencv2/core.hpp>

#include "cameras/feature_tracks.h"

namespace photohull {

struct DescribedTracks {
  std::vector<Track> tracks;
  std::vector<cv::Mat> descriptors;  ///< of each track: a row for each observation [Lowe04]
};

/// What find_tracks finds without given ones, with the features' descriptors.
DescribedTracks find_described_tracks(std::span<const PreparedView> views,
                                      const TrackOptions& options, Progress& progress);

}  // namespace photohull

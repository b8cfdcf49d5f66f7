// Which views can be compared by the points that they share. Internal to views.
#pragma once

#include <cstddef>
#include <vector>

#include "views/photometric.h"

namespace photohull {

/// Of `count` views, those connected by points that both see, with enough samples; the largest
/// group. None where no two are connected.
std::vector<bool> connected_views(const std::vector<PhotometricPoint>& points, std::size_t count,
                                  int least_samples);

/// The points' samples in used views; points that are left with one say nothing and go.
std::vector<PhotometricPoint> keep_used(const std::vector<PhotometricPoint>& points,
                                        const std::vector<bool>& used);

}  // namespace photohull

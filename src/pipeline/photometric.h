// Gains and vignetting of a scene's photographs, found from a surface, and what is reported.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/prepared_view.h"
#include "core/scene.h"
#include "views/photometric.h"

namespace photohull::pipeline {

enum class Photometric { kOff, kAuto, kOn };

const char* to_string(Photometric photometric);

struct PhotometricOutcome {
  PhotometricCalibration calibration;
  bool used = false;    ///< the views' pixels are to be divided by the gains
  std::string json;     ///< report.json's "photometric"
  std::string line;     ///< one line for the screen
  std::string warning;  ///< empty: none
};

/// A quick look (views/photometric_check.h) whether the views' gains differ by more than the noise
/// of their estimate, on some hundred points of the mesh, which may be coarse. Where they do not,
/// the outcome says so and the photographs stay. Where they do, or where these points cannot tell,
/// nothing is returned, and measure_photometric has to tell. Throws Error, Cancelled.
std::optional<PhotometricOutcome> find_alike(const TriMesh& mesh, double voxel_size,
                                             double noise_sigma,
                                             const std::vector<PreparedView>& views,
                                             const Progress& progress);

/// Measures the views' gains on the mesh (`voxel_size` in world units: about its
/// error; normals that it lacks come from its faces). They are to be used where
/// asked for (kOn) or where it pays (kAuto). `views` may be
/// cropped. Not to be called with kOff. Throws Error, Cancelled.
PhotometricOutcome measure_photometric(Photometric photometric, const TriMesh& mesh,
                                       double voxel_size, double noise_sigma,
                                       const std::vector<PreparedView>& views,
                                       const Progress& progress);

/// The views with their pixels divided by the gains that were measured on them.
std::vector<PreparedView> divide_by_gains(std::vector<PreparedView> views,
                                          const PhotometricCalibration& gains);

}  // namespace photohull::pipeline

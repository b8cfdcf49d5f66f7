// Where the photometric calibration gets its colours from, and how it changes the photographs.
#pragma once

#include <span>
#include <vector>

#include "core/mesh.h"
#include "core/prepared_view.h"
#include "core/scene.h"
#include "views/photometric.h"

namespace photohull {

/// How a photograph was taken: tells how far from the middle of the frame a pixel was, whatever
/// undistortion and cropping made of it since.
struct PhotometricFrame {
  Intrinsics intrinsics;  ///< of the file
  Distortion distortion;

  /// Squared distance of a pixel of `view` from the middle of the file's frame, 1 in its corners.
  double radius2(const Intrinsics& view, const glm::dvec2& pixel) const;
};

std::vector<PhotometricFrame> frames_of(std::span<const PreparedView> views);

/// Numbers lenses from 0: frames of the same size whose focal lengths differ by a hundredth at most
/// share one.
std::vector<int> shared_lenses(std::span<const PhotometricFrame> frames);

constexpr std::size_t kMostPhotometricPoints = 4000;

/// Colours of up to `most` vertices, spread evenly over the list, in the views that see them. A
/// view sees a vertex that faces it (cosine of 0.4 at least) where no triangle hides the point a
/// `patch` above it. Left out: windows (a square about as large as `patch` on each side, 1 to 6
/// pixels) that reach off the image, to unknown pixels or within two pixels of what the mask leaves
/// out, that hold saturated pixels, and points that are nearly black in a view. `patch` is in world
/// units, about the error of the surface; `noise_sigma` as estimate_image_noise says. The mesh
/// needs normals. Works in parallel; the result is the same whatever the number of threads.
std::vector<PhotometricPoint> sample_photometric(const TriMesh& mesh, double patch,
                                                 std::span<const PreparedView> views,
                                                 std::span<const PhotometricFrame> frames,
                                                 double noise_sigma, const Progress& progress,
                                                 std::size_t most = kMostPhotometricPoints);

/// Divides the views' pixels by what calibration found, in linear light; what exceeds 1 in 8-bit
/// images is clipped. Views that were not solved lose vignetting only.
void apply_photometric(const PhotometricCalibration& calibration,
                       std::span<const PhotometricFrame> frames,
                       const std::vector<int>& lens_of_view, std::span<PreparedView> views);

}  // namespace photohull

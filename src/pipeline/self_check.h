// The result against its own photographs: what the verdict rests on, gathered from the job.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "assess/silhouette_check.h"
#include "assess/verdict.h"
#include "core/mesh.h"
#include "core/prepared_view.h"
#include "core/scene.h"

namespace photohull::pipeline {

/// A job's coloured mesh and what it was made of.
struct CheckedResult {
  const TriMesh* mesh = nullptr;
  const Box* box = nullptr;
  const TriMesh* around = nullptr;  ///< what surrounds the box, if that was made
  const Box* around_box = nullptr;  ///< and how far
  double voxel_size = 0;            ///< world units
  bool hull = false;                ///< made by silhouettes alone
  bool bounded = false;             ///< do silhouettes bound it, so that it is judged by them?
  double share_beyond = 1;          ///< Hull::share_beyond
  std::span<const PreparedView> views;
  double mask_confidence = 0;
  double noise_sigma = 0;     ///< of the images, on square roots of full scale
  double stems = 0;           ///< share of the mesh's vertices that lines placed
  double stems_restored = 0;  ///< share of the lines' pixels that eaten masks had lost
  double contradiction = 0;  ///< of the silhouettes (assess::SilhouetteConsistency::uncovered_left)
  assess::CommonError common;      ///< of the views' outlines
  double cameras_moved = 0;        ///< pixels, by --refine-cameras
  double cameras_moved_alike = 0;  ///< pixels, of it what all views have in common
};

/// `fits`: how each view's silhouette is filled.
assess::Signals gather_signals(const CheckedResult& result,
                               std::vector<assess::SilhouetteFit>* fits = nullptr);

/// JSON: level, reasons and signals, and what is known of each view. `fits` as gather_signals gives
/// them: empty where there are no silhouettes.
std::string to_json(const assess::Verdict& verdict, const assess::Signals& signals,
                    std::span<const PreparedView> views,
                    std::span<const assess::SilhouetteFit> fits);

}  // namespace photohull::pipeline

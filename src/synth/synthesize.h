// The job: from a spec to a scene folder.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

#include "core/box.h"
#include "core/progress.h"
#include "synth/spec.h"

namespace photohull::synth {

/// What was made.
struct SynthesizedScene {
  int views = 0;
  std::size_t triangles = 0;
  double diagonal = 0;      ///< of the object's tight box, of all frames; world units
  double seen = 0;          ///< share of the surface that a camera sees
  double largest_fill = 0;  ///< share of a frame that the object covers, largest over the views
  std::vector<glm::dvec3> gains;  ///< of each view: exposure times white balance
  bool middlebury = true;  ///< false where lens distortion keeps that format from being written
};

/// The stages' weights, for the progress bar.
double total_weight(const Spec& spec);
double sequence_weight(Spec spec, int frames);

/// Renders the scene at the spec's moment and writes it to `folder`: images/, masks/, depth/,
/// normals/, gt.ply, gt_visible.ply, the cameras in every format and bbox.txt, spec.json last. The
/// same spec gives the same bytes, whatever the number of threads. Throws Error when the spec's
/// mesh, cameras or folder do not serve, and when a view sees nothing of the object; Cancelled when
/// asked to stop, the folder then being marked INCOMPLETE. Shadows by maps (light.shadow_test) are
/// drawn on `device`; another device may round them otherwise.
SynthesizedScene synthesize(const Spec& spec, const std::filesystem::path& folder,
                            Progress& progress, const std::string& device = "auto",
                            int threads = 0);

/// The same for each frame of a sequence, of as many frames as there are folders, one after the
/// other: with the same cameras, box, light and background, and with other noise. Whatever the
/// spec's moment was, that of a frame's spec.json is the frame, and makes the same bytes again.
/// What stops a frame leaves those before it as they are.
std::vector<SynthesizedScene> synthesize_frames(Spec spec,
                                                const std::vector<std::filesystem::path>& folders,
                                                Progress& progress,
                                                const std::string& device = "auto",
                                                int threads = 0);

}  // namespace photohull::synth

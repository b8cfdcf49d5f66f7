// Scenes on which visibility is measured, made from formulas.
#pragma once

#include <string>
#include <vector>

#include "core/camera.h"
#include "core/mesh.h"

namespace photohull::visibility {

struct StudyScene {
  std::string name;
  TriMesh mesh;
  Camera viewpoint;  ///< whose visibility is asked: a light, or an input camera
  Camera eye;        ///< sees the receivers; the whole scene
  Camera close_eye;  ///< sees about a quarter of it
};

/// Names of all scenes: assembly_250k and assembly_480k (decks, stairs, tanks, bundles of pipes
/// with small gaps), dense (2.4 million triangles), leaves (thin, open, many deep), wires (thinner
/// than a texel), ball.
const std::vector<std::string>& study_scene_names();

/// Throws UsageError for other names.
StudyScene make_study_scene(const std::string& name);

}  // namespace photohull::visibility

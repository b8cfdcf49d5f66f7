// What the photographs say of a mesh's vertices (render_bake_vertices.comp.glsl).
#pragma once

#include <vector>

#include "core/grid.h"
#include "core/mesh.h"
#include "core/progress.h"
#include "gpu/context.h"
#include "projtex/photographs.h"
#include "render/confidence.h"

namespace photohull::render {

/// By vertex. What nobody sees is black, with evidence of 0 views.
struct BakedVertices {
  std::vector<glm::vec3> colours;  ///< linear
  std::vector<SurfaceEvidence> evidence;
};

/// Colours as bake_colour() defines them, and what confidence follows from. Throws as that does.
BakedVertices bake_vertices(gpu::Context& context, const GridSpec& grid,
                            const projtex::Photographs& photographs, const TriMesh& mesh,
                            Progress& progress);

}  // namespace photohull::render

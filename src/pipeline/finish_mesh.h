// From the carved volume to the mesh that is delivered.
#pragma once

#include <string>
#include <vector>

#include "core/grid.h"
#include "core/mesh.h"
#include "pipeline/findings.h"
#include "pipeline/methods/method.h"
#include "render/bake_colour.h"

namespace photohull::pipeline {

/// What is known of each vertex beside the mesh's attributes.
struct SeenVertices {
  std::vector<float> views;         ///< that see it
  std::vector<float> disagreement;  ///< PooledEvidence::disagreement; NaN where no view sees it
};

SeenVertices seen_vertices(const std::vector<render::PooledEvidence>& evidence);

/// Small pieces go, but for those that masks ask for.
void remove_dust(const SurfaceJob& job, SparseVolume& volume);

/// The zero level set, with edges sharp that the method rounded, and with stems that are thinner
/// than voxels as wide as the masks say.
TriMesh extract_surface(const SurfaceJob& job, const SparseVolume& volume, MeshFindings& findings);

/// Colours and confidence; what the confidence of each vertex rests on. Warns where most is unseen.
/// Throws Error where the mesh is empty.
std::vector<render::PooledEvidence> colour_surface(const SurfaceJob& job, TriMesh& mesh,
                                                   MeshFindings& findings);

/// Without silhouettes knowledge ends where the photographs do.
bool leaves_open(const ReconstructOptions& options, bool bounded);

/// Leaves out what no camera sees, and without silhouettes what is more likely wrong than right.
/// After colouring, which tells what is seen, and before simplification, which keeps the border.
/// `seen` loses what is known of the vertices that go. Throws Error where nothing remains.
TriMesh open_unseen(const SurfaceJob& job, const TriMesh& mesh, SeenVertices& seen,
                    MeshFindings& findings);

/// Fewer triangles, as far from the uniform mesh as the options allow.
TriMesh simplify(const SurfaceJob& job, const TriMesh& mesh, MeshFindings& findings);

}  // namespace photohull::pipeline

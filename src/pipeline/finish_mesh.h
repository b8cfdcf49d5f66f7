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

/// The volume without small pieces, but for those that masks ask for.
SparseVolume remove_dust(const SurfaceJob& job, SparseVolume volume);

struct ExtractedSurface {
  TriMesh mesh;
  ExtractFindings findings;
};

/// The zero level set, with edges sharp that the method rounded, and with stems that are thinner
/// than voxels as wide as the masks say.
ExtractedSurface extract_surface(const SurfaceJob& job, const SparseVolume& volume);

struct ColouredSurface {
  TriMesh mesh;
  std::vector<render::PooledEvidence> evidence;  ///< that the confidence of each vertex rests on
  ColourFindings findings;
};

/// The mesh with colours and confidence. Warns where most of it is unseen. Throws Error where it is
/// empty.
ColouredSurface colour_surface(const SurfaceJob& job, TriMesh mesh);

/// Without silhouettes knowledge ends where the photographs do.
bool leaves_open(const ReconstructOptions& options, bool bounded);

struct OpenSurface {
  TriMesh mesh;
  SeenVertices seen;  ///< of the vertices that remain
  IslandFindings findings;
};

/// The mesh without what no camera sees, and without silhouettes also without what is more likely
/// wrong than right. After colouring, which tells what is seen, and before simplification, which
/// keeps the border. Throws Error where nothing remains.
OpenSurface open_unseen(const SurfaceJob& job, const TriMesh& mesh, SeenVertices seen);

struct SimplifiedSurface {
  TriMesh mesh;
  MeshErrorFindings findings;
};

/// Fewer triangles, as far from the uniform mesh as the options allow.
SimplifiedSurface simplify(const SurfaceJob& job, const TriMesh& mesh);

}  // namespace photohull::pipeline

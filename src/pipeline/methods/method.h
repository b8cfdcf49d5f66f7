// The methods that carve a surface: a table with an entry each.
#pragma once

#include <cstdint>
#include <span>

#include "core/grid.h"
#include "core/mesh.h"
#include "core/progress.h"
#include "gpu/context.h"
#include "pipeline/findings.h"
#include "pipeline/hull.h"
#include "pipeline/part.h"
#include "pipeline/photographs.h"
#include "pipeline/reconstruct_options.h"
#include "pipeline/subject.h"
#include "pipeline/tuning.h"
#include "projtex/image_set.h"
#include "projtex/out_of_core.h"
#include "refine/follow.h"

namespace photohull::pipeline {

/// What a method carves, and with what. All outlives it.
struct SurfaceJob {
  const ReconstructOptions& options;
  const Photographs& photographs;  ///< that the subject was made of
  const Subject& subject;
  gpu::Context& context;
  Hull& hull;
  const projtex::ImageSet*
      images;           ///< of the subject's views; null once the surface has its colours
  bool bounded = true;  ///< do silhouettes bound the surface?
  Progress& progress;
  projtex::OutOfCorePhotographs* larger = nullptr;  ///< to match the surface in; may be null
  const refine::MomentBefore* before = nullptr;     ///< the surface a moment ago; may be null
  const Part* part = nullptr;          ///< of a whole, that is carved alone; null: the whole is
  std::span<const DepthMap> beside{};  ///< the part, of each of the subject's views (depths_beside)
};

struct Surface {
  SparseVolume volume;  ///< never empty
  SurfaceFindings findings;
};

/// A box around the subject's.
struct AroundBox {
  GridSpec grid;
  Box box;
  double nearest_angle = 0;  ///< degrees between views that are matched
};

/// What a face of the box takes, in voxels (pipeline/estimate.h).
struct MethodCost {
  double face_seconds = 0, unmasked_face_seconds = 0;  ///< CPU; with silhouettes, and without
  double unmasked_face_bytes = 0;                      ///< without silhouettes
  double unmasked_pixel_seconds = 0;  ///< CPU, of a photograph's, without silhouettes
};

struct MethodEntry {
  Method method;
  const char* name;  ///< as options have it
  /// Does it sweep planes, so that the options of the sweeps are its own?
  bool sweeps;
  /// Do silhouettes alone shape it? Then colours, confidence and verdict say nothing of
  /// photographs.
  bool by_silhouettes;
  /// Does it find surface without silhouettes, also around cameras?
  bool needs_no_silhouettes;
  /// Can it match in photographs that are larger than those that are held (SurfaceJob::larger)?
  bool matches_larger;
  /// Can it start from the surface of the moment before (SurfaceJob::before)?
  bool follows;
  /// Can it carve a part by what its voxels see and what lies beside it (SurfaceJob::part)?
  bool in_parts;
  /// Does it begin with the hull at the lattice's voxels?
  bool from_hull;
  const char* stage;  ///< its name for progress and the report; null: none, the hull is the result
  double weight;      ///< of the stage (pipeline/stage_weights.h)
  MethodCost cost;
  /// Its parameters, for --tune; null: none.
  void (*describe)(Described& to, Parameters& parameters);
  /// Throws Error where nothing is found; Cancelled. `hull` is empty unless `from_hull`.
  Surface (*carve)(const SurfaceJob& job, SparseVolume hull);
  /// Sharpens edges that it rounds; returns how many vertices moved. Null: it rounds none.
  std::int64_t (*sharpen)(const SurfaceJob& job, TriMesh& mesh);
  /// Surface in another box, which no silhouettes bound; may be empty. Adds texture samples to
  /// `samples`. Null: it has none.
  SparseVolume (*carve_around)(const SurfaceJob& job, const AroundBox& around,
                               std::int64_t& samples);
};

/// In the order in which they are named.
std::span<const MethodEntry> methods();
const MethodEntry& method_of(Method method);
const MethodEntry& method_of(const ReconstructOptions& options);

#define PHOTOHULL_METHOD(value, entry) extern const MethodEntry entry;
#include "pipeline/methods/methods.def"

}  // namespace photohull::pipeline

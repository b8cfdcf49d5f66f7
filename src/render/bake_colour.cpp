// Visibility as in L. Williams, "Casting curved shadows on curved surfaces", SIGGRAPH 1978; weights
// in the spirit of P. Debevec, C. Taylor, J. Malik, "Modeling and rendering architecture from
// photographs", SIGGRAPH 1996.
#include "render/bake_colour.h"

#include <utility>

#include "core/error.h"
#include "render/kernels/bake_vertices.h"

namespace photohull {

void bake_colour(gpu::Context& context, const GridSpec& grid, const projtex::ImageSet& images,
                 std::span<const Camera> cameras, double noise_sigma, render::Shaping shaping,
                 TriMesh& mesh, Progress& progress, BakeReport* report,
                 std::vector<render::PooledEvidence>* evidence) {
  PHOTOHULL_CHECK_OP(int(cameras.size()), ==, images.layers());
  PHOTOHULL_CHECK_OP(mesh.normals.size(), ==, mesh.positions.size());
  PHOTOHULL_CHECK_OP(noise_sigma, >, 0.0);
  render::BakedVertices baked =
      render::bake_vertices(context, grid, {images, cameras, noise_sigma}, mesh, progress);
  const std::size_t total = mesh.positions.size();
  mesh.colours = std::move(baked.colours);
  mesh.confidence.assign(total, 0);
  std::vector<render::PooledEvidence> pooled = render::pool_evidence(mesh, baked.evidence);
  BakeReport counts;
  baked = {};
  for (std::size_t i = 0; i < total; ++i) {
    mesh.confidence[i] = float(render::confidence_of(pooled[i], shaping));
    counts.seen += pooled[i].seen;
    counts.mean_confidence += mesh.confidence[i];
  }
  render::fill_unseen(mesh);
  counts.vertices = std::int64_t(total);
  if (counts.seen > 0) counts.mean_confidence /= double(counts.seen);
  if (report) *report = counts;
  if (evidence) *evidence = std::move(pooled);
}

}  // namespace photohull

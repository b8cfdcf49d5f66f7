// Visibility as in L. Williams, "Casting curved shadows on curved surfaces", SIGGRAPH 1978; weights
// in the spirit of P. Debevec, C. Taylor, J. Malik, "Modeling and rendering architecture from
// photographs", SIGGRAPH 1996.
#include "render/bake_colour.h"

#include <utility>

#include "core/error.h"
#include "render/kernels/bake_vertices.h"

namespace photohull {

BakeReport bake_colour(gpu::Context& context, const GridSpec& grid,
                       const projtex::Photographs& photographs, render::Shaping shaping,
                       TriMesh& mesh, Progress& progress) {
  PHOTOHULL_CHECK_OP(int(photographs.cameras.size()), ==, photographs.images.layers());
  PHOTOHULL_CHECK_OP(mesh.normals.size(), ==, mesh.positions.size());
  PHOTOHULL_CHECK_OP(photographs.noise_sigma, >, 0.0);
  render::BakedVertices baked = render::bake_vertices(context, grid, photographs, mesh, progress);
  const std::size_t total = mesh.positions.size();
  mesh.colours = std::move(baked.colours);
  mesh.confidence.assign(total, 0);
  BakeReport report;
  report.vertices = std::int64_t(total);
  report.evidence = render::pool_evidence(mesh, baked.evidence);
  baked = {};
  for (std::size_t i = 0; i < total; ++i) {
    mesh.confidence[i] = float(render::confidence_of(report.evidence[i], shaping));
    report.seen += report.evidence[i].seen;
    report.mean_confidence += mesh.confidence[i];
  }
  render::fill_unseen(mesh);
  if (report.seen > 0) report.mean_confidence /= double(report.seen);
  return report;
}

}  // namespace photohull

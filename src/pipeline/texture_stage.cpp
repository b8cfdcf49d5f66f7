#include "pipeline/texture_stage.h"

#include <algorithm>
#include <cmath>

#include "io/mesh/mesh_writers.h"
#include "mesh/simplify_mesh.h"
#include "pipeline/read_scene.h"
#include "texture/texture_mesh.h"

namespace photohull::pipeline {
namespace {

constexpr double kTexturedError = 0.25;  // voxels
constexpr std::int64_t kLeastBytes = std::int64_t(48) << 20;
constexpr int kShareOfMemory = 3;
constexpr double kLeastAgreement = 0.2;  // length of the mean of the photographs' upward directions

TextureFindings found(const TriMesh& mesh, const TextureReport& report) {
  TextureFindings out;
  out.triangles = std::int64_t(mesh.triangles.size());
  out.pages = report.pages;
  out.width = report.width;
  out.height = report.height;
  out.scale = report.scale;
  out.charts = report.charts;
  out.views = report.views;
  out.texels = report.texels;
  out.filled_share = report.texels ? double(report.filled) / double(report.texels) : 0;
  out.unseen_share = report.unseen_share;
  out.bytes = report.bytes;
  return out;
}

}  // namespace

bool makes_texture(const ReconstructOptions& options) {
  if (options.texture.off) return false;
  return std::ranges::any_of(mesh_writers(), [&](const MeshWriter& writer) {
    return writer.holds_textures &&
           std::ranges::find(options.exports, writer.name) != options.exports.end();
  });
}

std::int64_t texture_bytes(std::int64_t limit) {
  return std::clamp(limit / kShareOfMemory, kLeastBytes, kMostTextureBytes);
}

MadeTexture make_textured(const SurfaceJob& job, const TriMesh& uniform, const TriMesh& delivered) {
  TriMesh mesh = job.options.mesh_error.value > 0
                     ? delivered
                     : simplify_mesh(delivered, kTexturedError * job.subject.grid.voxel_size);
  job.progress.check_cancelled();
  const TextureOptions options{.edge = job.options.texture.edge,
                               .noise = job.subject.noise_sigma,
                               .bytes = texture_bytes(memory_limit(job.options)),
                               .detail = job.options.texture.detail};
  TextureResult made = texture_mesh(mesh, uniform, job.subject.views, options, job.progress);
  const TextureFindings findings = found(mesh, made.report);
  return {{std::move(mesh), std::move(made.texture)}, findings};
}

glm::dvec3 upward_axis(std::span<const PreparedView> views) {
  glm::dvec3 sum(0);
  for (const PreparedView& view : views) {
    const glm::dmat3& r = view.camera.cam_from_world.rotation;
    sum -= glm::dvec3(r[0][1], r[1][1], r[2][1]);  // the image's y axis points down
  }
  glm::dvec3 up(0);
  if (glm::length(sum) < kLeastAgreement * double(views.size())) return {0, 0, 1};
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(sum[i]) > std::abs(sum[axis])) axis = i;
  up[axis] = sum[axis] < 0 ? -1 : 1;
  return up;
}

}  // namespace photohull::pipeline

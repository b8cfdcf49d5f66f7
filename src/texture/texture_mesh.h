// A texture for a mesh, from the photographs that see it.
#pragma once

#include <cstdint>
#include <span>

#include "core/mesh.h"
#include "core/mesh_texture.h"
#include "core/prepared_view.h"
#include "core/progress.h"

namespace photohull {

inline constexpr int kLeastTextureEdge = 128;
inline constexpr int kMostTextureEdge = 4096;

/// Beyond which the work takes no more (a page of 4096 squared, its charts, and maps).
inline constexpr std::int64_t kMostTextureBytes = std::int64_t(768) << 20;

struct TextureOptions {
  /// Longest edge of the texture, texels, a power of two: it is then one page, with coarser texels
  /// where the photographs hold more. 0: texels as fine as the photographs' pixels.
  int edge = 0;
  int page_edge = kMostTextureEdge;  ///< of pages at most where `edge` is 0; a power of two
  double noise = 0;  ///< standard deviation of the photographs' pixels, roots of linear light
  /// That the work may take beside meshes, photographs and finished pages: fewer maps of
  /// photographs are kept, fewer charts are painted at a time, and pages are smaller (1024 texels
  /// along each side in any case).
  std::int64_t bytes = kMostTextureBytes;
  double detail = 1;  ///< what is finer than about two texels is multiplied by it
};

struct TextureReport {
  std::int64_t pages = 0;
  int width = 0, height = 0;  ///< of every page, texels
  double scale = 1;           ///< texels for a pixel of the photographs, along each side
  std::int64_t charts = 0;
  std::int64_t views = 0;   ///< photographs that colours come from
  std::int64_t texels = 0;  ///< that show the surface
  std::int64_t filled = 0;  ///< of these, that no photograph shows clear of outlines
  double unseen_share = 0;  ///< of the mesh's area, for which all texels are filled
  double seam_length = 0;   ///< between photographs, world units
  std::int64_t bytes = 0;   ///< that the work took at most (TextureOptions::bytes)
};

struct TextureResult {
  MeshTexture texture;
  TextureReport report;
};

/// Makes a texture atlas for `mesh`. Every triangle gets one photograph, by its quality there
/// (texture/face_views.h) and so that few seams run over the surface (texture/label_faces.h);
/// connected triangles of a photograph are a chart, in which texels are the photograph's own
/// pixels. Levels of charts are made to meet (texture/seams.h), and photographs are blended within
/// some texels of a seam.
///
/// Colours come only from pixels that are some pixels away from the outlines of the mesh, of the
/// mask, and of parts that stand before others; and where depth maps say that the surface is seen.
/// What no photograph shows so takes the colour of the nearest point of `coloured`, a mesh of the
/// same surface with colours at its vertices; so does what of a triangle is hidden.
///
/// `mesh.colours`, where there are any, tell photographs that show something else. `views` must not
/// be empty. In parallel; the same for any number of threads. Throws Error when the mesh has no
/// triangles, or more charts than fit onto one page at any scale; UsageError for an edge that is
/// out of range or no power of two; Cancelled.
TextureResult texture_mesh(const TriMesh& mesh, const TriMesh& coloured,
                           std::span<const PreparedView> views, const TextureOptions& options,
                           Progress& progress);

}  // namespace photohull

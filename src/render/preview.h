// One picture of a reconstruction for people.
#pragma once

#include <span>

#include "core/mesh.h"
#include "core/mesh_texture.h"
#include "core/prepared_view.h"
#include "core/rgb_image.h"
#include "gpu/context.h"

namespace photohull {

struct PreviewOptions {
  int panel_edge = 512;  ///< longest side of a panel of the top row, pixels; in [16, 4096]
  int other_views = 2;   ///< viewpoints of the bottom row at most; in [0, 4]
};

/// Top row: a photograph, the coloured mesh from that very camera, and the mesh as clay under a
/// headlight and a soft second light; all three cut to where the mesh is. Bottom row: clay and
/// colour from up to `other_views` other cameras, as far apart in direction as the scene allows,
/// turned to frame the whole mesh. The main view is the one that sees the mesh largest and whole.
///
/// A mesh without triangles gives the first photograph alone. mesh.normals must be present when
/// there are triangles; without mesh.colours the colour is clay's. `views` must not be empty.
/// Throws Error when the device cannot hold the mesh or the picture.
RgbImage render_preview(gpu::Context& context, const TriMesh& mesh,
                        std::span<const PreparedView> views, const PreviewOptions& options = {});

/// The same of a mesh with a texture, whose colours it has.
RgbImage render_preview(gpu::Context& context, const TexturedMesh& textured,
                        std::span<const PreparedView> views, const PreviewOptions& options = {});

}  // namespace photohull

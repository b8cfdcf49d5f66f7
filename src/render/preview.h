// One picture of a reconstruction for people.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh.h"
#include "core/prepared_view.h"
#include "gpu/context.h"

namespace photohull {

/// 8-bit sRGB, row-major from the top-left, 3 bytes a pixel.
struct PreviewImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

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
PreviewImage render_preview(gpu::Context& context, const TriMesh& mesh,
                            std::span<const PreparedView> views,
                            const PreviewOptions& options = {});

}  // namespace photohull

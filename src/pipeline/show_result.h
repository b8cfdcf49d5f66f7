// What the report's page shows of a result (page/make_page.h).
#pragma once

#include <span>
#include <vector>

#include "core/mesh.h"
#include "core/mesh_texture.h"
#include "core/prepared_view.h"
#include "page/make_page.h"
#include "pipeline/finish_mesh.h"

namespace photohull::pipeline {

/// The mesh in at most kShownTriangles triangles, with confidence, views that see it and their
/// disagreement, and the views with their photographs made small: all pictures together take at
/// most kPictureBytes, and no more than kMostPictures views have one. `seen` tells of the mesh's
/// first vertices; of the others, what surrounds the box, it is not known.
page::Shown show_result(const TriMesh& mesh, SeenVertices seen,
                        std::span<const PreparedView> views);

/// The same of a textured mesh: with its texture, as one image of at most kTextureBytes. `uniform`
/// is the mesh that `seen` tells of; it has the confidence.
page::Shown show_textured(const TexturedMesh& textured, const TriMesh& uniform,
                          const SeenVertices& seen, std::span<const PreparedView> views);

/// What both of these show: the views, and the layers of a model.
page::Shown show_views(std::span<const PreparedView> views);
std::vector<page::Layer> layers_of(const TriMesh& mesh, SeenVertices seen);

inline constexpr std::size_t kTextureBytes = 400000;
inline constexpr std::size_t kShownTriangles = 200000;
inline constexpr std::size_t kPictureBytes = 480000;
inline constexpr int kMostPictures = 240;

}  // namespace photohull::pipeline

// Pages of a result that nobody made: a wrinkled ball among cameras, with names that want to be
// markup.
#pragma once

#include <string>

#include "core/mesh.h"
#include "page/make_page.h"

namespace photohull::test {

/// A closed mesh of 2 * rings * rings triangles around (1000, 0, 0), of radius about 1, with
/// normals, colours and confidence, some of them 0.
TriMesh wrinkled_ball(int rings);

/// A name that ends scripts and attributes where it is not escaped.
inline constexpr const char* kHostileName =
    "a</script><script>alert(1)</script><img src=x onerror=alert(2)>\"'&<!--";

/// Six cameras in a ring, 200 x 150 pixels, with photographs of one colour each.
std::vector<page::ShownView> ring_of_views();

/// report.json of a doubtful result with these views. Paths, warnings and reasons hold the name.
std::string sample_report(const TriMesh& mesh);

/// The model with the layers that a reconstruction has.
page::Shown sample_shown(const TriMesh& mesh);
/// The same with a texture in place of the vertices' colours.
page::Shown textured_shown(const TriMesh& mesh);
std::vector<page::Layer> sample_layers(const TriMesh& mesh);

}  // namespace photohull::test

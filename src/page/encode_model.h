// A mesh made small, for a page.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/mesh.h"

namespace photohull::page {

/// A number of each vertex that colours can show.
struct Layer {
  std::string name;
  std::vector<float> values;  ///< NaN: not known
  double most = 1;            ///< shown values are 0 to this; what is beyond counts as this
};

/// What a page has of a model: a table of its streams of bytes, and the streams.
struct Model {
  /// JSON: `vertices`, `triangles`, `low` (world, of the lowest corner), `step` (world units of one
  /// count of a position), and `streams`, a list in the order of the bytes: `name`, `components`,
  /// `bytes` of each component and, of layers, `step` of a count.
  std::string table;
  std::string packed;  ///< the bytes, deflated, as base64
};

/// Triangles are ordered so that they share vertices with those before them, and vertices by their
/// first use. Streams:
///
///   position   3 x 16 bits, in steps of the mesh's longest side / 65535
///   place      2 x 16 bits, in steps of 1 / 8191, where the mesh has a texture
///   colour     3 x 8 bits sRGB, where the mesh has colours
///   layers     8 bits each: 0 to 254 for 0 to `most`, 255 where nothing is known
///   triangles  32 bits a corner: how far below the vertex not used yet it is; 0 is that vertex
///
/// Vertices' numbers are differences to the vertex before, as zigzag codes (0, -1, 1, -2, ...),
/// modulo what their bits hold. The bytes of a stream come component by component, of each
/// component the lowest bytes of all elements first: what is alike lies together and deflates well.
/// Normals are not kept, as the triangles tell them.
///
/// The mesh needs triangles. Layers have a value for each vertex, and so have `places` on a
/// texture, in [0, 1] from its top-left corner; empty: there is none.
Model encode_model(const TriMesh& mesh, std::span<const Layer> layers,
                   std::span<const glm::vec2> places = {});

}  // namespace photohull::page

// Contract of the visibility maps: what a viewpoint sees, drawn once and asked often. Lengths are
// world units relative to the geometry's origin; map positions are in texels, texel (i, j) covering
// [i, i + 1) x [j, j + 1).
#ifndef PHOTOHULL_SHADERS_VISIBILITY_H
#define PHOTOHULL_SHADERS_VISIBILITY_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace photohull::shaders {
using glm::ivec4;
using glm::uint;
using glm::uvec4;
using glm::vec4;
#elif !defined(constexpr)
#define constexpr const
#endif

// What maps are asked by.
constexpr int kMapInfoBinding = 1;
constexpr int kMapTrianglesBinding = 4;  // MapTriangle, of each partition in turn
constexpr int kMapListEndsBinding = 5;   // a texel: where its list of triangles begins, or its nearest one
constexpr int kMapListBinding = 6;
constexpr int kMapListRestBinding = 7;   // what goes beyond a storage block
constexpr int kFirstDepthUnit = 0;
constexpr int kSecondDepthUnit = 1;
constexpr int kNearestIdsUnit = 2;
constexpr int kDepthMomentsUnit = 3;
constexpr int kReceiversBinding = 0;     // Receiver
constexpr int kFractionsBinding = 1;
constexpr int kLinksBinding = 1;         // of the kernel that lists the triangles of a texel

// What maps are drawn by.
constexpr int kFaceBricksBinding = 2;       // the brick of each pair of triangles
constexpr int kMarchTableBinding = 2;       // bricks of a volume
constexpr int kMarchOccupancyBinding = 3;   // its voxels, one bit each
constexpr int kMarchDepthsUnit = 0;
constexpr int kMarchIdsUnit = 1;
constexpr int kBlurSourceUnit = 0;
constexpr int kBlurMomentsUnit = 0;
constexpr int kLargeTrianglesBinding = 0;   // those that a work group takes
constexpr int kCoverDepthsBinding = 1;      // a texel
constexpr int kMeshPositionsBinding = 2;
constexpr int kMeshIndicesBinding = 3;
constexpr int kCoverWordsBinding = 5;       // a texel: its triangle, their number, or where to write

constexpr int kMaxMapParts = 4;     // partitions in depth
constexpr int kMaxLinks = 4;        // triangles that coverage detection links to a texel
constexpr uint kNoTriangle = 0xffffffffu;

// One partition of a map. For a point p: (x, y, w) = rows . (p, 1), map position (x, y) / w; depth
// along the viewpoint's axis = row_z . (p, 1), which a warp leaves alone [MartinTan04].
struct MapProjection {
  vec4 row_x;
  vec4 row_y;
  vec4 row_w;
  vec4 row_z;
  vec4 depth_of_w;  // xyz: depth = w * dot(xyz, (X, Y, 1)) at map position (X, Y); w: where
                    // w_clip = nearest, clip z is this
};

struct MapInfo {
  MapProjection parts[kMaxMapParts];
  vec4 eye_row;     // depth before the receivers' camera = eye_row . (p, 1)
  vec4 part_ends;   // eye depths up to which each partition serves
  ivec4 size;       // x, y: texels of a partition; z: partitions; w: triangles
  vec4 bias;        // x: constant, world units; y: slope's factor; z: z_max of dual depth; w: width
                    // of a texel at depth 1
  vec4 range;       // x, y: nearest and farthest depth of the geometry; z: bleeding that variance
                    // maps cut off
  vec4 view_x;      // homogeneous position on the viewpoint's image, in units of the image: (s, t) /
  vec4 view_y;      //   depth lies in [0, 1] on it
  uvec4 lists;      // x: words of all texels' lists that the first storage block holds
};

struct Receiver {  // a point whose visibility is asked
  vec4 position;   // xyz
  vec4 normal;     // xyz: unit
  vec4 step_x;     // xyz: to the neighbouring sample in x, on the tangent plane
  vec4 step_y;     // the same in y
  uvec4 id;        // x: triangle or brick it lies on, kNoTriangle where unknown
};

// A triangle on a map. With (u, v) = position - anchor: 1 / w = inverse_w + slope . (u, v), and
// barycentric coordinates over w: b1 / w = edge1 . (u, v), b2 / w = edge2 . (u, v).
struct MapTriangle {
  vec4 anchor;  // x, y: map position of the vertex with the greatest w; z: its 1 / w, 0 for a triangle
                // without area or behind the viewpoint
  vec4 slopes;  // xy: slope; zw: edge1
  vec4 edge2;   // xy: edge2; z, w: least and greatest depth
};

#ifdef __cplusplus
static_assert(sizeof(MapProjection) == 80);
static_assert(sizeof(MapInfo) == 80 * kMaxMapParts + 128);
static_assert(sizeof(Receiver) == 80);
static_assert(sizeof(MapTriangle) == 48);
}  // namespace photohull::shaders
#endif

#endif  // PHOTOHULL_SHADERS_VISIBILITY_H

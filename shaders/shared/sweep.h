// Contract of the plane-sweep kernels. A layer is a slice of the grid one voxel thick across the
// sweep's axis; layer 0 lies nearest to the cameras that look along the sweep.
#ifndef PHOTOHULL_SHADERS_SWEEP_H
#define PHOTOHULL_SHADERS_SWEEP_H

#include "shared/depth_map.h"

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

// Devices are sure to have eight storage blocks, so that what no step has together shares a binding.
// Cameras are at kViewsBinding, depth maps where shared/depth_map.h says.
constexpr int kSweepParametersBinding = 0;
constexpr int kSweepActiveBinding = 0;           // bricks that a sweep has to look at
constexpr int kSweepItemsBinding = 1;            // LayerItem
constexpr int kSweepDecisionsBinding = 1;        // Decision
constexpr int kSweepSelectedBinding = 2;         // bricks with columns to judge
constexpr int kSweepSelectedColumnsBinding = 2;  // SelectedColumn
constexpr int kSweepScoresBinding = 3;
constexpr int kSweepTableBinding = 4;            // bricks of the bits
constexpr int kSweepOccupancyBinding = 5;        // which voxels stand, one bit each
constexpr int kSweepPassedBinding = 5;           // voxels that hide what the sweep comes to, one bit each
constexpr int kSweepSamplesBinding = 6;          // colours on the layer
constexpr int kSweepColumnsBinding = 7;          // Column

constexpr int kMaxLayerViews = 8;  // views projected onto one brick's part of a layer
constexpr int kPatchRadius = 2;     // voxels: patches of 5 x 5 on the reference plane
constexpr int kApronEdge = 12;      // 8 + 2 * kPatchRadius
constexpr int kApronArea = 144;
constexpr int kSearchRounds = 2;   // of r-consistency: how often each view chooses its shift

struct SweepParameters {
  ivec4 bricks;      // grid size in bricks; w: items of this brick layer
  ivec4 axes;        // x, y: the two axes in the plane; z: the sweep's axis; w: +1 or -1
  ivec4 layer;       // x: layer; y: first row of voxels in the plane whose columns are held; w: 1 for planes through the voxels' front faces, 0 through their centres
  vec4 thresholds;   // x: score that keeps; y: least gain of a better explanation; z: least views;
                     // w: bias of the depth test in voxels
  vec4 noise;        // x: variance of image noise (square-root encoding); y: least confidence of a
                     // score; z: least texture variance
  ivec4 chunk;       // x: first selected brick of this dispatch, whose samples start at 0;
                     // y: longest path in layers; z, w: first and number of its columns
};

struct LayerItem {
  ivec4 brick;                     // xyz: brick coordinates; w: number of views
  uvec4 views[kMaxLayerViews / 4];  // view indices, most frontal first
};

struct SelectedColumn {  // to be judged on a layer
  uint brick;            // which of the selected bricks
  uint item;             // that brick's LayerItem
  int u, v;              // voxel in the plane
};

struct Column {       // the open path of a column of voxels
  ivec4 path;         // x: layer where it starts, -1 when none is open; y: layer of its best score
  vec4 scores;        // x: score at the start; y: best score
};

constexpr int kKept = 0;       // consistent where it is bare
constexpr int kBetter = 1;     // inconsistent, and a layer behind is clearly better
constexpr int kUndecided = 2;  // inconsistent, but nothing behind is better
constexpr int kUnseen = 3;     // too few cameras or too little texture to say anything

struct Decision {
  ivec4 place;        // x, y: column; z: layer of the bare voxel; w: layer of the surface
  vec4 scores;        // x: score at the bare voxel; y: best score; z: outcome (kKept, ...)
};

#ifdef __cplusplus
static_assert(sizeof(SweepParameters) == 96);
static_assert(sizeof(LayerItem) == 48);
static_assert(sizeof(SelectedColumn) == 16);
static_assert(sizeof(Column) == 32);
static_assert(sizeof(Decision) == 32);
}  // namespace photohull::shaders
#endif

#endif  // PHOTOHULL_SHADERS_SWEEP_H

#version 450 core
#extension GL_GOOGLE_include_directive : require
// Plane sweep, step 4: what becomes of the judged voxels. A consistent voxel stays. An inconsistent
// one opens a path: the sweep goes on through its column as if it were empty, until a clearly better
// explanation is found behind (a peak of the score above the threshold) or the path ends without one.
// The outcome is only noted here; carving::apply_decisions weighs it against its neighbours, so that
// no voxel goes because it looks wrong, only because something behind it looks right.
// Reference: carving::reference::ColumnJudge.
#include "include/dispatch.glsl"
#include "include/layer.glsl"
#include "include/occupancy.glsl"
#include "include/selection.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = kSweepColumnsBinding) buffer Columns { Column columns[]; };
layout(std430, binding = kOccludersBinding) buffer Occluders { uint occluder_count; uint pad3, pad4, pad5; ivec4 occluders[]; };
layout(std430, binding = kSweepScoresBinding) readonly buffer Scores { vec4 scores[]; };
layout(std430, binding = kSweepActiveBinding) buffer Active { uint active_bricks[]; };
layout(std430, binding = kSweepDecisionsBinding) buffer Decisions { uint decision_count; uint judged; uint pad6, pad7; Decision decisions[]; };

const int kPeakLayers = 2;  // a peak is one when no better score follows within this many layers

// The voxel where the surface is taken to be hides what lies behind it for the rest of the sweep.
void decide(ivec2 uv, int bare, int surface, float score, float best, int outcome) {
  occluders[atomicAdd(occluder_count, 1u)] = ivec4(layer_voxel(uv, surface), 0);
  decisions[atomicAdd(decision_count, 1u)] =
      Decision(ivec4(uv, bare, surface), vec4(score, best, float(outcome), 0.0));
}

void close_path(ivec2 uv, inout Column column) {
  bool better = column.scores.y >= parameters.thresholds.x &&
                column.scores.y >= column.scores.x + parameters.thresholds.y;
  decide(uv, column.path.x, better ? column.path.y : column.path.x, column.scores.x,
         column.scores.y, better ? kBetter : kUndecided);
  column.path.x = -1;
}

void main() {
  uint index = invocation().x;
  if (index >= uint(parameters.chunk.w)) return;
  ivec2 uv = ivec2(selected_columns[index].u, selected_columns[index].v);
  int layer = parameters.layer.x;
  Column column = columns[column_index(uv)];
  vec4 score = scores[index];
  bool enough = score.w >= parameters.thresholds.z && score.z >= parameters.noise.y;
  atomicAdd(judged, 1u);

  if (column.path.x < 0) {
    if (!enough || score.x >= parameters.thresholds.x) {
      decide(uv, layer, layer, score.x, score.x, enough ? kKept : kUnseen);
      return;
    }
    column.path = ivec4(layer, layer, 0, 0);
    column.scores = vec4(score.x, score.x, 0.0, 0.0);
  } else if (!standing(layer_voxel(uv, layer)) || layer > column.path.x + parameters.chunk.y) {
    close_path(uv, column);
  } else {
    if (enough && score.x > column.scores.y) {
      column.scores.y = score.x;
      column.path.y = layer;
    }
    bool past_peak = column.scores.y >= parameters.thresholds.x && layer >= column.path.y + kPeakLayers;
    if (past_peak) close_path(uv, column);
  }
  columns[column_index(uv)] = column;
  ivec3 next = layer_voxel(uv, layer + 1);
  if (column.path.x >= 0 && on_grid(next)) active_bricks[brick_at(next)] = 1u;
}

// The bricks of a layer, and the views that each is judged by.
#include "include/layer.glsl"

layout(std430, binding = kSweepItemsBinding) readonly buffer Items { LayerItem items[]; };

// In-plane coordinates of the first column of an item.
ivec2 item_origin(uint item) {
  ivec4 brick = items[item].brick;
  return ivec2(brick[parameters.axes.x], brick[parameters.axes.y]) * 8;
}

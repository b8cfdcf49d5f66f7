// The columns that a layer's steps work on, packed: software devices run whole vectors of threads.
layout(std430, binding = kSweepSelectedBinding) readonly buffer Selected { uint selected_count; uint selected_pad[3]; uvec4 selected[]; };
layout(std430, binding = kSweepSelectedColumnsBinding) readonly buffer SelectedColumns { uint selected_columns[]; };

struct Selection {
  uint entry;   // which selected brick
  uint item;
  uint column;  // 0 to 63 within the brick's part of the layer
  ivec2 uv;     // in-plane voxel coordinates
};

Selection selection_of(uint index) {
  Selection s;
  s.entry = selected_columns[index] >> 6u;
  s.column = selected_columns[index] & 63u;
  s.item = selected[s.entry].x;
  s.uv = item_origin(s.item) + ivec2(s.column & 7u, s.column >> 3u);
  return s;
}

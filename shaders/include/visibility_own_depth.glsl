// No virtual samples: the receiver's own depth at all positions.
// Reference: visibility::reference::Map::receiver_depth.
vec2 prepare(Receiver r, MapPoint m) { return vec2(0.0); }
float receiver_depth(vec2 prepared, MapPoint m, vec2 at) { return m.z; }

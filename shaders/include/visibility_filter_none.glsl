// One test. Reference: visibility::reference::Map::visible.
float fraction_visible(Receiver r, MapPoint m) { return lit(r, prepare(r, m), m, m.at) ? 1.0 : 0.0; }

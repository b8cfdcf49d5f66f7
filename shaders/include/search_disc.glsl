// Where each view looks for what a voxel shows, pixels from its projection (carving::search_disc); the
// projection alone unless SEARCH_... give more.
#ifdef SEARCH_TAPS
const vec2 kSearchOffsets[SEARCH_TAPS] = vec2[](SEARCH_OFFSETS);
#else
#define SEARCH_TAPS 1
const vec2 kSearchOffsets[1] = vec2[](vec2(0.0));
#endif

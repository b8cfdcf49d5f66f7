// Coverage detection [Li17]: the triangles of a texel are its own nearest and those of its 8 neighbours
// that hold one of its corners, up to four. Worked out where it is asked: a map has many more texels than
// receivers. Reference: visibility::reference::Map::links_of.

bool holds_corner(MapTriangle t, ivec2 texel) {
  for (int k = 0; k < 4; ++k)
    if (contains(t, vec2(texel) + vec2(k & 1, k >> 1))) return true;
  return false;
}

uint nearest_beside(int part, ivec2 texel, int k) {
  ivec2 at = texel + ivec2(k % 3 - 1, k / 3 - 1);
  if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, map_info.size.xy))) return kNoTriangle;
  return nearest_triangles[index_of(part, at)];
}

uvec4 links_of(int part, ivec2 texel) {
  uvec4 found = uvec4(nearest_triangles[index_of(part, texel)], kNoTriangle, kNoTriangle, kNoTriangle);
  int count = found.x == kNoTriangle ? 0 : 1;
  // Most texels have the triangle of all their neighbours: only others are looked at, one a turn.
  uint others = 0u;
  for (int k = 0; k < 9; ++k) {
    uint triangle = nearest_beside(part, texel, k);
    if (triangle != kNoTriangle && triangle != found.x) others |= 1u << k;
  }
  do {
    int k = others == 0u ? 4 : findLSB(others);
    others &= others - 1u;
    uint triangle = nearest_beside(part, texel, k);
    if (triangle != kNoTriangle && !any(equal(found, uvec4(triangle))) &&
        holds_corner(triangle_of(part, triangle), texel))
      found[count++] = triangle;
  } while (others != 0u && count < kMaxLinks);
  return found;
}

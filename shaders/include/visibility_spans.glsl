// Conservative rasterisation in a compute shader: which texels of a row a triangle touches, exactly.
layout(std430, binding = kMeshPositionsBinding) readonly buffer Positions { float positions[]; };
layout(std430, binding = kMeshIndicesBinding) readonly buffer Indices { uint indices[]; };

struct MapPolygon {
  vec2 at[4];
  int corners;  // 0 where nothing lies before the viewpoint
};

vec3 position_of(uint vertex) {
  return vec3(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
}

// The part of a triangle that lies beyond the nearest w.
MapPolygon polygon_of(int part, uint triangle) {
  float nearest = map_info.parts[part].depth_of_w.w;
  vec3 h[3];
  for (int i = 0; i < 3; ++i) h[i] = homogeneous(part, vec4(position_of(indices[3u * triangle + uint(i)]), 1.0));
  MapPolygon p;
  p.corners = 0;
  for (int i = 0; i < 3; ++i) {
    vec3 a = h[i], b = h[(i + 1) % 3];
    if (a.z >= nearest) p.at[p.corners++] = a.xy / a.z;
    if ((a.z >= nearest) != (b.z >= nearest)) {
      vec3 c = mix(a, b, (nearest - a.z) / (b.z - a.z));
      p.at[p.corners++] = c.xy / nearest;
    }
  }
  return p;
}

// First and last row that the polygon touches, on the map.
ivec2 rows_of(MapPolygon p) {
  float low = 1e30, high = -1e30;
  for (int i = 0; i < p.corners; ++i) {
    low = min(low, p.at[i].y);
    high = max(high, p.at[i].y);
  }
  return ivec2(floor(max(low, 0.0)), ceil(min(high, float(map_info.size.y))) - 1.0);
}

// First and last texel of a row that the polygon touches, on the map.
ivec2 span_of(MapPolygon p, int row) {
  float top = float(row), bottom = top + 1.0;
  float low = 1e30, high = -1e30;
  for (int i = 0; i < p.corners; ++i) {
    vec2 a = p.at[i], b = p.at[i + 1 == p.corners ? 0 : i + 1];
    if (a.y > b.y) {
      vec2 c = a;
      a = b;
      b = c;
    }
    if (b.y < top || a.y > bottom) continue;
    float slope = b.y > a.y ? (b.x - a.x) / (b.y - a.y) : 0.0;
    float from = a.y < top ? a.x + slope * (top - a.y) : a.x;
    float to = b.y > bottom ? a.x + slope * (bottom - a.y) : b.x;
    low = min(low, min(from, to));
    high = max(high, max(from, to));
  }
  return ivec2(floor(max(low, 0.0)), ceil(min(high, float(map_info.size.x))) - 1.0);
}

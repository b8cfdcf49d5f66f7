// A view's image on a patch of a tangent plane, or of the paraboloid that touches it there
// (PATCH_BENT): one affine footprint, taps at its steps.
#ifndef PATCH_RADIUS
#define PATCH_RADIUS 2
#endif
const int kEdge = 2 * PATCH_RADIUS + 1;
// Every other place of the lattice, as on a chessboard: half the samples tell nearly as much.
#if PATCH_RADIUS > 1
const int kStride = 2;
#else
const int kStride = 1;
#endif
const int kTaps = (kEdge * kEdge + kStride - 1) / kStride;

// Where tap k lies, in steps between places from the middle.
vec2 place_of_tap(int k) {
  return vec2(float(kStride * k % kEdge - PATCH_RADIUS), float(kStride * k / kEdge - PATCH_RADIUS));
}

layout(binding = kImagesUnit) uniform sampler2DArray images;

struct PatchFootprint {
  vec2 origin, du, dv;  // texture coordinates of the middle and steps between taps
  vec2 dn;              // step along the normal, texture coordinates a voxel
  float layer, lod;
};

// The mip level is that of the tap's area.
PatchFootprint footprint(int v, vec3 centre, vec3 u, vec3 w, vec3 normal) {
  GpuView view = views[v];
  vec3 p = project(view, centre);
  vec2 pixel = p.xy / p.z;
  vec3 s = (view.row_s.xyz - pixel.x * view.row_q.xyz) / p.z, t = (view.row_t.xyz - pixel.y * view.row_q.xyz) / p.z;
  vec2 du = vec2(dot(s, u), dot(t, u)), dv = vec2(dot(s, w), dot(t, w));
  PatchFootprint f;
  f.lod = floor(max(0.5 * log2(abs(du.x * dv.y - du.y * dv.x)), 0.0) + 0.5);
  f.du = du * view.size.zw;
  f.dv = dv * view.size.zw;
  f.dn = vec2(dot(s, normal), dot(t, normal)) * view.size.zw;
  f.origin = texture_coordinate(view, pixel);
  f.layer = float(v);
  return f;
}

// Square roots of linear light, which makes the noise even, centred so that products keep precision.
// `bend`: the height over the plane is bend . (a^2, a b, b^2) voxels, a and b in steps between taps.
vec3 tap(PatchFootprint f, int k, vec3 bend) {
  vec2 place = place_of_tap(k);
  vec2 at = f.origin + place.x * f.du + place.y * f.dv;
#ifdef PATCH_BENT
  at += dot(bend, vec3(place.x * place.x, place.x * place.y, place.y * place.y)) * f.dn;
#endif
  return sqrt(max(textureLod(images, vec3(at, f.layer), f.lod).rgb, 0.0)) - 0.5;
}

// Steps between taps in the tangent plane: at least so many voxels, and pixels of the reference.
void patch_axes(vec3 centre, vec3 normal, GpuView reference, float voxels, float pixels, out vec3 u,
                out vec3 w) {
  float pixel = length(reference.centre.xyz - centre) / reference.centre.w;
  float spacing = max(voxels, pixels * pixel);
  vec3 helper = abs(normal.x) < 0.6 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  u = normalize(cross(helper, normal));
  w = cross(normal, u) * spacing;
  u *= spacing;
}

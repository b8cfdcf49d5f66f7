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

// A patch of the plane that touches a surfel, or of the paraboloid where it bends.
struct TangentPatch {
  vec3 centre, normal;  // voxel coordinates; unit
  vec3 u, w;            // steps between taps in the plane, voxels
  vec3 bend;            // the height over the plane is bend . (a^2, a b, b^2) voxels, a and b in steps between taps
};

// Where a view sees a patch.
struct PatchFootprint {
  vec2 origin, du, dv;  // texture coordinates of the middle and steps between taps
  vec2 dn;              // step along the normal, texture coordinates a voxel
  float layer, lod;
};

// The flat patch around a point; its taps are at least so many voxels apart, and pixels of the reference.
TangentPatch tangent_patch(vec3 centre, vec3 normal, GpuView reference, float voxels, float pixels) {
  float pixel = length(reference.centre.xyz - centre) / reference.centre.w;
  float spacing = max(voxels, pixels * pixel);
  vec3 helper = abs(normal.x) < 0.6 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  TangentPatch t;
  t.centre = centre;
  t.normal = normal;
  t.u = normalize(cross(helper, normal));
  t.w = cross(normal, t.u) * spacing;
  t.u *= spacing;
  t.bend = vec3(0.0);
  return t;
}

// The image of a patch in the view whose photograph lies in a layer; the mip level is that of the tap's area.
PatchFootprint footprint(GpuView view, int layer, TangentPatch t) {
  vec3 p = project(view, t.centre);
  vec2 pixel = p.xy / p.z;
  vec3 by_s = (view.row_s.xyz - pixel.x * view.row_q.xyz) / p.z, by_t = (view.row_t.xyz - pixel.y * view.row_q.xyz) / p.z;
  vec2 du = vec2(dot(by_s, t.u), dot(by_t, t.u)), dv = vec2(dot(by_s, t.w), dot(by_t, t.w));
  PatchFootprint f;
  f.lod = floor(max(0.5 * log2(abs(du.x * dv.y - du.y * dv.x)), 0.0) + 0.5);
  f.du = du * view.size.zw;
  f.dv = dv * view.size.zw;
  f.dn = vec2(dot(by_s, t.normal), dot(by_t, t.normal)) * view.size.zw;
  f.origin = texture_coordinate(view, pixel);
  f.layer = float(layer);
  return f;
}

// Colour at a tap: square roots of linear light, which makes the noise even, centred so that products keep
// precision. `bend` is the patch's; without PATCH_BENT patches are flat.
vec3 tap(PatchFootprint f, int k, vec3 bend) {
  vec2 place = place_of_tap(k);
  vec2 at = f.origin + place.x * f.du + place.y * f.dv;
#ifdef PATCH_BENT
  at += dot(bend, vec3(place.x * place.x, place.x * place.y, place.y * place.y)) * f.dn;
#endif
  return sqrt(max(textureLod(images, vec3(at, f.layer), f.lod).rgb, 0.0)) - 0.5;
}

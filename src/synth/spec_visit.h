// The one list of a spec's fields, for reading and for writing. Internal to synth.
#pragma once

#include "synth/spec.h"

namespace photohull::synth {

// A visitor has, each with the field's name first:
//   number(name, double&, low, high)     integer(name, int&, low, high)   seed(name, uint64&)
//   flag(name, bool&)                    text(name, string&)              choice(name, string&,
//   {...}) vector(name, dvec3& or dvec2&, low, high) numbers(name, vector<double>&, low, high)
//   integers(name, vector<int>&, low, high) object(name, function)               objects(name,
//   vector<T>&, function of T&) shape(GeometrySpec&) motion(const GeometrySpec&, MotionSpec&)

inline constexpr double kFar = 1e9;
inline constexpr double kFullTurn = 360;  ///< degrees that the geometry may be turned by
inline constexpr double kFarthest = 1e6;  ///< that it may be moved

template <typename Visitor>
void visit_material(Visitor& v, MaterialSpec& m) {
  v.vector("base", m.base, 0, 1);
  v.choice("pattern", m.pattern, {"noise", "checker"});
  v.number("contrast", m.contrast, 0, 1);
  v.number("size", m.size, 1e-4, 10);
  v.integer("octaves", m.octaves, 1, 12);
  v.number("gain", m.gain, 0, 1);
  v.number("chroma", m.chroma, 0, 1);
  v.number("period_pixels", m.period_pixels, 0, 1000);
  v.flag("faces", m.faces);
  v.number("gloss", m.gloss, 0, 10);
  v.number("roughness", m.roughness, 0.02, 1);
  v.number("haze", m.haze, 0, 1);
  v.number("haze_depth", m.haze_depth, 0, 1);
}

/// Exact rays, and every named technique of visibility maps.
std::vector<std::string> shadow_tests();

template <typename Visitor>
void visit_light(Visitor& v, LightSpec& l) {
  v.vector("ambient", l.ambient, 0, 100);
  v.objects("directional", l.directional, [&](DirectionalLight& d) {
    v.vector("direction", d.direction, -kFar, kFar);
    v.vector("colour", d.colour, 0, 100);
  });
  v.objects("point", l.point, [&](PointLight& p) {
    v.vector("position", p.position, -1000, 1000);
    v.vector("colour", p.colour, 0, 10000);
  });
  v.flag("shadows", l.shadows);
  v.choice("shadow_test", l.shadow_test, shadow_tests());
  v.integer("shadow_texels", l.shadow_texels, 16, 8192);
}

template <typename Visitor>
void visit_cameras(Visitor& v, CameraSpec& c) {
  v.choice("layout", c.layout, {"rings", "hemisphere", "arc", "within"});
  v.objects("rings", c.rings, [&](Ring& r) {
    v.integer("count", r.count, 1, kMostViews);
    v.number("elevation", r.elevation, -89.9, 89.9);
    v.number("phase", r.phase, -1000, 1000);
  });
  v.integer("count", c.count, 1, kMostViews);
  v.number("lowest", c.lowest, -90, 90);
  v.number("highest", c.highest, -90, 90);
  v.number("arc", c.arc, 0, 360);
  v.number("azimuth", c.azimuth, -360, 360);
  v.number("crowding", c.crowding, 1, 20);
  v.number("elevation", c.elevation, -89.9, 89.9);
  v.numbers("turns", c.turns, -360, 360);
  v.number("pitch", c.pitch, -80, 80);
  v.number("field_of_view", c.field_of_view, 5, 150);
  v.number("distance", c.distance, 0, 1000);
  v.numbers("distances", c.distances, 0.01, 100);
  v.numbers("focals", c.focals, 0.01, 100);
  v.number("fill", c.fill, 0.01, 10);
  v.vector("principal_offset", c.principal_offset, -kLargestImage, kLargestImage);
  v.number("roll", c.roll, 0, 180);
  v.flag("turntable", c.turntable);
}

template <typename Visitor>
void visit_degradations(Visitor& v, DegradationSpec& d) {
  v.seed("seed", d.seed);
  v.number("photon_noise", d.photon_noise, 0, 1);
  v.number("read_noise", d.read_noise, 0, 1);
  v.number("code_noise", d.code_noise, 0, 255);
  v.number("blur", d.blur, 0, 50);
  v.number("edge_blur", d.edge_blur, 0, 50);
  v.number("motion_blur", d.motion_blur, 0, 200);
  v.number("motion_blur_views", d.motion_blur_views, 0, 1);
  v.number("exposure", d.exposure, 0, 5);
  v.number("white_balance", d.white_balance, 0, 3);
  v.number("vignetting", d.vignetting, 0, 1);
  v.integer("jpeg", d.jpeg, 0, 100);
  v.number("k1", d.k1, -5, 5);
  v.number("k2", d.k2, -50, 50);
  v.number("p1", d.p1, -1, 1);
  v.number("p2", d.p2, -1, 1);
  v.number("pose_error", d.pose_error, 0, 100);
  v.number("intrinsics_error", d.intrinsics_error, 0, 100);
  v.vector("pixel_shift", d.pixel_shift, -1000, 1000);
  v.flag("ignore_distortion", d.ignore_distortion);
  v.number("wrong_views", d.wrong_views, 0, 1);
  v.number("wrong_turn", d.wrong_turn, 0, 180);
  v.number("view_shift", d.view_shift, 0, 50);
  v.number("view_shift_views", d.view_shift_views, 0, 1);
  v.number("mask_grow", d.mask_grow, -100, 100);
  v.choice("mask_style", d.mask_style, {kCoverage, kAliased, kCut, kEroded});
  v.number("mask_cut", d.mask_cut, 0.01, 1);
  v.integer("mask_holes", d.mask_holes, 0, 1000);
  v.number("mask_hole_radius", d.mask_hole_radius, 0.5, 500);
  v.integers("mask_wrong", d.mask_wrong, 0, kMostViews - 1);
  v.number("missing", d.missing, 0, 0.95);
  v.integers("missing_views", d.missing_views, 0, kMostViews - 1);
  v.integer("shuffle", d.shuffle, 0, 1000000);
  v.number("box_scale", d.box_scale, 0.01, 1000);
  v.vector("box_shift", d.box_shift, -100, 100);
}

template <typename Visitor>
void visit_spec(Visitor& v, Spec& s) {
  v.text("name", s.name);
  v.seed("seed", s.seed);
  v.object("geometry", [&] {
    v.shape(s.geometry);
    v.number("scale", s.geometry.scale, 1e-6, 1e6);
    v.vector("rotate", s.geometry.rotate, -kFullTurn, kFullTurn);
    v.vector("translate", s.geometry.translate, -kFarthest, kFarthest);
  });
  v.motion(s.geometry, s.motion);
  v.object("moment", [&] {
    v.integer("frame", s.moment.frame, 0, kMostFrames - 1);
    v.integer("frames", s.moment.frames, 1, kMostFrames);
  });
  v.object("material", [&] { visit_material(v, s.material); });
  v.object("light", [&] { visit_light(v, s.light); });
  v.object("background", [&] {
    v.choice("type", s.background.type, {"colour", "clutter"});
    v.vector("colour", s.background.colour, 0, 1);
    v.number("size", s.background.size, 0.001, 10);
    v.number("distance", s.background.distance, 1.1, 1000);
    v.flag("moving", s.background.moving);
    v.flag("plates", s.background.plates);
  });
  v.object("sheet", [&] {
    v.text("board", s.sheet.board);
    v.number("fill", s.sheet.fill, 0.01, 10);
    v.number("print", s.sheet.print, 0.1, 10);
    v.vector("bend", s.sheet.bend, -100, 100);
    v.number("hidden", s.sheet.hidden, 0, 1);
    v.vector("turn", s.sheet.turn, -360, 360);
  });
  v.object("image", [&] {
    v.integer("width", s.image.width, 8, kLargestImage);
    v.integer("height", s.image.height, 8, kLargestImage);
    v.integer("samples", s.image.samples, 1, 16);
    v.integer("bits", s.image.bits, 8, 16);
    v.flag("maps", s.image.maps);
    v.flag("masks", s.image.masks);
  });
  v.object("cameras", [&] { visit_cameras(v, s.cameras); });
  v.object("degradations", [&] { visit_degradations(v, s.degradations); });
  v.integer("truth_samples", s.truth_samples, 100, 20000000);
}

}  // namespace photohull::synth

#include "synth/motion.h"

#include <cmath>

namespace photohull::synth {
namespace {

constexpr double kFrameWeight = 0.1;  ///< to build a frame's mesh

/// Where the pattern of the first frame is, on the surface of this one.
OwnFrame own_frame(const GeometrySpec& first, const GeometrySpec& now, const Box& all) {
  OwnFrame own;
  if (now.rotate != first.rotate)
    own.rotation = turn_by(first.rotate) * transpose(turn_by(now.rotate));
  own.middle = now.translate + transpose(own.rotation) * (all.center() - first.translate);
  own.size = all.size();
  own.diagonal = all.diagonal();
  return own;
}

}  // namespace

bool moves(const Spec& spec) { return spec.moment.frames > 1 && !spec.motion.empty(); }

GeometrySpec geometry_of_frame(const Spec& spec, int frame) {
  const double share = double(frame) / spec.moment.frames;
  GeometrySpec now = spec.geometry;
  for (const auto& [name, ends] : spec.motion.parameters)
    now.parameters[name] = ends[0] + (ends[1] - ends[0]) * share;
  if (!spec.motion.rotate.empty())
    now.rotate = spec.motion.rotate[0] + (spec.motion.rotate[1] - spec.motion.rotate[0]) * share;
  if (!spec.motion.translate.empty())
    now.translate =
        spec.motion.translate[0] + (spec.motion.translate[1] - spec.motion.translate[0]) * share;
  return now;
}

std::optional<Box> box_of_frames(const Spec& spec, Progress& progress) {
  if (!moves(spec)) return std::nullopt;
  progress.stage("box of all frames", box_weight(spec));
  Box all{glm::dvec3(INFINITY), glm::dvec3(-INFINITY)};
  for (int frame = 0; frame < spec.moment.frames; ++frame) {
    progress.check_cancelled();
    const Box box = tight_box(make_mesh(geometry_of_frame(spec, frame)));
    all.min = min(all.min, box.min);
    all.max = max(all.max, box.max);
    progress.update(double(frame + 1) / spec.moment.frames);
  }
  return all;
}

double box_weight(const Spec& spec) { return moves(spec) ? kFrameWeight * spec.moment.frames : 0; }

Surface surface_at_moment(const Spec& spec, const std::optional<Box>& all) {
  const GeometrySpec now = geometry_of_frame(spec, spec.moment.frame);
  Surface surface = make_surface(now, spec.sheet.board.empty() ? glm::dvec3(0.0) : spec.sheet.turn);
  if (!all) return surface;
  surface.box = *all;
  surface.diagonal = all->diagonal();
  surface.own = own_frame(geometry_of_frame(spec, 0), now, *all);
  surface.moves = true;
  return surface;
}

}  // namespace photohull::synth

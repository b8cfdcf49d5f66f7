#include "calib/sheet_problem.h"

#include <algorithm>

#include "calib/object_error.h"
#include "calib/tag_edges.h"
#include "core/error.h"

namespace photohull {
namespace {

constexpr double kStatedFocal = 0.1, kAnyFocal = 0.4;  // deviations of its logarithm
constexpr double kStretched = 0.05;                    // mm
constexpr double kHuber = 2.5;                         // deviations of the noise

/// How tags around a cylinder appear in a photograph.
struct ArcProjection {
  LensModel model;
  const Lens& lens;
  Pose pose;

  glm::dvec2 at(const glm::dvec3& place) const {
    const glm::dvec3 q = pose.rotation * place + pose.translation;
    glm::dvec2 pixel;
    project(model, lens.data(), &q.x, &pixel.x);
    return pixel;
  }

  /// The line that is fitted to the measured part of an arc.
  std::array<glm::dvec2, 2> line(const glm::dvec3& from, const glm::dvec3& to) const {
    constexpr int kSteps = 16;
    const double start = std::atan2(from.y, from.x), radius = glm::length(glm::dvec2(from));
    const double turn = std::remainder(std::atan2(to.y, to.x) - start, 2 * M_PI);
    std::array<glm::dvec2, kSteps> points;
    glm::dvec2 middle(0);
    for (int i = 0; i < kSteps; ++i) {
      const double share = kTagEdgeMargin + (1 - 2 * kTagEdgeMargin) * (i + 0.5) / kSteps;
      const double angle = start + share * turn;
      points[std::size_t(i)] = at({radius * std::cos(angle), radius * std::sin(angle), from.z});
      middle += points[std::size_t(i)] / double(kSteps);
    }
    double xx = 0, xy = 0, yy = 0;
    for (const glm::dvec2& p : points) {
      const glm::dvec2 d = p - middle;
      xx += d.x * d.x, xy += d.x * d.y, yy += d.y * d.y;
    }
    const double slope = 0.5 * std::atan2(2 * xy, xx - yy);
    return {middle, {std::cos(slope), std::sin(slope)}};
  }

  /// Pixels from a tag's corners to where the lines through its edges meet, in their order.
  std::array<glm::dvec2, 4> moves(const glm::dvec3* corners) const {
    const std::array arcs = {line(corners[0], corners[1]), line(corners[3], corners[2])};
    std::array<glm::dvec2, 4> all;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& [middle, along] = arcs[i / 2];
      const glm::dvec2 corner = at(corners[i]), upright = at(corners[3 - i]) - corner;
      const double sine = upright.x * along.y - upright.y * along.x;
      const glm::dvec2 way = middle - corner;
      all[i] = sine == 0 ? glm::dvec2(0) : (way.x * along.y - way.y * along.x) / sine * upright;
    }
    return all;
  }
};

}  // namespace

std::vector<double> SheetProblem::errors(const SheetPhoto& photo) const {
  std::vector<double> all;
  for (std::size_t i = 0; i < photo.view.points.size(); ++i) {
    const SheetResidual residual{model, reach, photo.view.points[i], photo.view.pixels[i]};
    glm::dvec2 off;
    const bool before =
        residual(cameras[photo.camera].lens.data(), photo.pose.data(), bend.data(), &off.x);
    all.push_back(before ? glm::length(off) : INFINITY);
  }
  return all;
}

double SheetProblem::rms(const SheetPhoto& photo) const {
  double sum = 0;
  for (const double e : errors(photo)) sum += e * e;
  return std::sqrt(sum / std::max(1.0, double(photo.view.points.size())));
}

void SheetProblem::add_all(ceres::Problem& problem, bool bent) {
  for (SheetPhoto& photo : photos) {
    if (!photo.used) continue;
    const double weight = 1 / (photo.noise * photo.noise);
    for (std::size_t i = 0; i < photo.view.points.size(); ++i)
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<SheetResidual, 2, 12, 6, 3>(
              new SheetResidual{model, reach, photo.view.points[i], photo.view.pixels[i]}),
          new ceres::ScaledLoss(new ceres::HuberLoss(kHuber * photo.noise), weight,
                                ceres::TAKE_OWNERSHIP),
          cameras[photo.camera].lens.data(), photo.pose.data(), bend.data());
  }
  for (SheetCamera& camera : cameras) {
    if (!problem.HasParameterBlock(camera.lens.data())) continue;
    const double focal = camera.stated_focal > 0 ? camera.stated_focal : camera.lens[0];
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<LensPrior, 12, 12>(new LensPrior{
            focal, camera.stated_focal > 0 ? kStatedFocal : kAnyFocal, glm::dvec2(camera.size)}),
        nullptr, camera.lens.data());
    hold_lens(problem, model, false, camera.lens);
  }
  if (bent && !stretches)
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<PaperPrior, 1, 3>(new PaperPrior{kStretched}), nullptr,
        bend.data());
  if (!bent) problem.SetParameterBlockConstant(bend.data());
}

void SheetProblem::follow_arcs() {
  for (SheetPhoto& photo : photos) {
    if (!photo.used) continue;
    const ArcProjection projection{model, cameras[photo.camera].lens, pose_of(photo.pose)};
    for (std::size_t k = 0; k + 4 <= photo.view.points.size(); k += 4) {
      const auto moves = projection.moves(&photo.view.points[k]);
      for (std::size_t i = 0; i < 4; ++i) {
        photo.view.pixels[k + i] += photo.moved[k + i] - moves[i];
        photo.moved[k + i] = moves[i];
      }
    }
  }
}

double SheetProblem::refine(bool bent) {
  ceres::Problem problem;
  add_all(problem, bent);
  std::vector<double*> poses;
  for (SheetPhoto& photo : photos)
    if (photo.used) poses.push_back(photo.pose.data());
  solve(problem, poses);
  double cost = 0;
  problem.Evaluate({}, &cost, nullptr, nullptr, nullptr);
  return cost;
}

SheetProblem::Deviations SheetProblem::deviations(bool bent, const glm::dvec3& low,
                                                  const glm::dvec3& high) {
  ceres::Problem problem;
  add_all(problem, bent);
  const StandardDeviations sigmas(problem);
  Deviations d;
  for (std::size_t c = 0; c < cameras.size(); ++c) d.lenses[c] = sigmas.of(cameras[c].lens.data());
  for (std::size_t i = 0; i < photos.size(); ++i)
    if (photos[i].used) d.poses[i] = sigmas.of(photos[i].pose.data());
  const std::vector<double> bend_sigma = sigmas.of(bend.data());
  if (!bend_sigma.empty()) std::copy(bend_sigma.begin(), bend_sigma.end(), d.bend.begin());
  ObjectError error(problem, sigmas);
  for (const glm::dvec3& point : points_throughout(low, high))
    for (SheetPhoto& photo : photos)
      if (photo.used)
        error.add<SheetResidual, 12, 6, 3>(photo.view.size(), {model, reach, point, {}},
                                           cameras[photo.camera].lens.data(), photo.pose.data(),
                                           bend.data());
  d.object_error = error.rms();
  return d;
}

}  // namespace photohull

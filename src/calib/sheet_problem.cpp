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
  // A line that is fitted to a parabola's middle part lies so far from its ends, of its height.
  constexpr double kPart = 1 - 2 * kTagEdgeMargin, kShare = 1 - kPart * kPart / 3;
  for (SheetPhoto& photo : photos) {
    if (!photo.used) continue;
    const Pose pose = pose_of(photo.pose);
    const glm::dvec3 eye = -(glm::transpose(pose.rotation) * pose.translation);
    for (std::size_t k = 0; k + 4 <= photo.view.points.size(); k += 4) {
      glm::dvec3* const p = &photo.view.points[k];
      const glm::dvec2 chord = 0.5 * glm::dvec2(p[0] + p[1]);
      const double height = glm::length(glm::dvec2(p[0])) - glm::length(chord);
      const glm::dvec3 way = 0.25 * (p[0] + p[1] + p[2] + p[3]) - eye;
      const double inwards = -glm::dot(glm::dvec2(way), glm::normalize(chord));
      // Seen from above the arc bulges downwards.
      const double down = inwards > 0 ? -kShare * height * way.z / inwards : 0;
      for (std::size_t i = 0; i < 4; ++i) {
        p[i].z += photo.lowered[k + i] - down;
        photo.lowered[k + i] = down;
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

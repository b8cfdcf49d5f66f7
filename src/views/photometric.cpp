// Based on: D. Goldman, "Vignette and exposure calibration and compensation", PAMI 2010
// [Goldman10] (the model, solved over points that several photographs show); K.-Y. Liang, S. Zeger,
// "Longitudinal data analysis using generalized linear models", Biometrika 1986 [Liang86]
// (covariance with clustered errors).
#include "views/photometric.h"

#include <ceres/ceres.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "core/error.h"
#include "core/median.h"
#include "core/option_word.h"
#include "views/photometric_overlap.h"

namespace photohull {
namespace {

constexpr int kRounds = 4;         // of solving; the loss's width follows the residuals
constexpr int kIterations = 10;    // of a round: the next one has another loss
constexpr double kSettled = 1e-5;  // share of the cost by which the last step lowers it
constexpr double kFirstWidth = 5;  // deviations
constexpr double kCauchy = 2.385;  // of the residuals' deviation: 95 % efficient
constexpr double kMedianToSigma = 1.483;
constexpr double kLeastVignetting = 0.0, kMostVignetting = 0.9;
constexpr double kGaugeWeight = 1e3;     // of the mean logarithm, in deviations
constexpr double kVignettingSigmas = 3;  // below: not distinguished from none

glm::dvec3 logarithm(const glm::dvec3& v) { return glm::log(v); }

/// (log colour - log gain - log(1 - v r^2) - log albedo) / sigma, for three channels.
class Residual : public ceres::SizedCostFunction<3, 3, 3, 1> {
 public:
  explicit Residual(const PhotometricSample& sample)
      : seen_(logarithm(sample.colour)), weight_(1.0 / sample.sigma), radius2_(sample.radius2) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const double kept = 1 - parameters[2][0] * radius2_, lost = std::log(kept);
    for (int c = 0; c < 3; ++c)
      residuals[c] = weight_[c] * (seen_[c] - parameters[0][c] - lost - parameters[1][c]);
    if (!jacobians) return true;
    for (int block = 0; block < 2; ++block)
      for (int i = 0; jacobians[block] && i < 9; ++i)
        jacobians[block][i] = i % 4 == 0 ? -weight_[i / 4] : 0;
    for (int c = 0; jacobians[2] && c < 3; ++c) jacobians[2][c] = weight_[c] * radius2_ / kept;
    return true;
  }

 private:
  glm::dvec3 seen_, weight_;
  double radius2_;
};

/// Holds the mean of all gains' logarithms at 0.
struct Gauge {
  int count;
  template <typename T>
  bool operator()(T const* const* gains, T* residual) const {
    for (int c = 0; c < 3; ++c) {
      residual[c] = T(0);
      for (int i = 0; i < count; ++i) residual[c] += gains[i][c];
      residual[c] *= kGaugeWeight / count;
    }
    return true;
  }
};

/// The unknowns, all but the vignetting as logarithms.
struct State {
  std::vector<glm::dvec3> gain, albedo;
  std::vector<double> vignetting;
  std::vector<bool> vignetting_free;
};

class Solver {
 public:
  Solver(const std::vector<PhotometricPoint>& points, const std::vector<int>& lens_of_view,
         const std::vector<bool>& used, const Progress& progress)
      : points_(points), lens_(lens_of_view), used_(used), progress_(progress) {
    for (std::size_t i = 0; i < used.size(); ++i)
      if (used[i]) views_.push_back(i);
  }

  void run(State& state) {
    width_ = kFirstWidth;
    ceres::Problem problem;
    ceres::ParameterBlockOrdering order;
    auto* loss = new ceres::LossFunctionWrapper(nullptr, ceres::TAKE_OWNERSHIP);  // the problem's
    set_up(loss, state, problem, order);
    for (int round = 0; round < kRounds; ++round) {
      progress_.check_cancelled();
      loss->Reset(new ceres::CauchyLoss(width_), ceres::TAKE_OWNERSHIP);
      solve(order, problem);
      std::vector<double> sizes;
      for_each(state, [&](std::size_t, const PhotometricSample&, const glm::dvec3& r) {
        for (int c = 0; c < 3; ++c) sizes.push_back(std::abs(r[c]));
      });
      width_ = kCauchy * std::max(0.05, kMedianToSigma * median(sizes));
    }
  }

  /// Covariance of (gains of used views, three each; vignetting of each lens).
  Eigen::MatrixXd covariance(const State& state) const {
    const auto gains = Eigen::Index(3 * views_.size());
    const Eigen::Index n = gains + Eigen::Index(state.vignetting.size());
    std::vector<Eigen::Index> column(used_.size(), -1);
    for (std::size_t i = 0; i < views_.size(); ++i) column[views_[i]] = Eigen::Index(3 * i);
    Eigen::MatrixXd bread = Eigen::MatrixXd::Zero(n, n);
    std::map<int, Eigen::VectorXd> scores;
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const PhotometricPoint& point = points_[p];
      Eigen::VectorXd& score =
          scores.try_emplace(point.cluster, Eigen::VectorXd::Zero(n)).first->second;
      for (int c = 0; c < 3; ++c) {
        std::vector<std::pair<Eigen::Index, double>> row;  // weighted sums over the point's samples
        double total = 0;
        for (const PhotometricSample& s : point.samples) {
          const glm::dvec3 r = residual(state, p, s);
          const double w = 1 / (s.sigma[c] * s.sigma[c]) / (1 + glm::dot(r, r) / (width_ * width_));
          const auto lens = std::size_t(lens_[std::size_t(s.view)]);
          const Eigen::Index g = column[std::size_t(s.view)] + c, v = gains + Eigen::Index(lens);
          const double dv = state.vignetting_free[lens]
                                ? -s.radius2 / (1 - state.vignetting[lens] * s.radius2)
                                : 0.0;
          bread(g, g) += w, bread(v, v) += w * dv * dv;
          bread(g, v) += w * dv, bread(v, g) += w * dv;
          score[g] += w * r[c] * s.sigma[c], score[v] += w * dv * r[c] * s.sigma[c];
          row.emplace_back(g, w), row.emplace_back(v, w * dv);
          total += w;
        }
        for (const auto& [i, a] : row)  // the albedo eliminated
          for (const auto& [j, b] : row) bread(i, j) -= a * b / total;
      }
    }
    Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(n, n);
    for (const auto& [cluster, score] : scores) meat += score * score.transpose();
    // The gauge, and lenses that are held.
    const double scale = bread.diagonal().mean() / double(views_.size());
    for (std::size_t i = 0; i < views_.size(); ++i)
      for (std::size_t j = 0; j < views_.size(); ++j)
        for (int c = 0; c < 3; ++c)
          bread(Eigen::Index(3 * i) + c, Eigen::Index(3 * j) + c) += scale;
    for (std::size_t l = 0; l < state.vignetting.size(); ++l)
      if (!(bread(gains + Eigen::Index(l), gains + Eigen::Index(l)) > 0))
        bread(gains + Eigen::Index(l), gains + Eigen::Index(l)) = 1;
    const Eigen::MatrixXd inverse = bread.completeOrthogonalDecomposition().pseudoInverse();
    // Few clusters say too little of their own spread.
    const double clusters = double(scores.size());
    return inverse * meat * inverse * (clusters / std::max(1.0, clusters - 1));
  }

 private:
  glm::dvec3 residual(const State& state, std::size_t point, const PhotometricSample& s) const {
    const double v = state.vignetting[std::size_t(lens_[std::size_t(s.view)])];
    return (logarithm(s.colour) - state.gain[std::size_t(s.view)] - std::log(1 - v * s.radius2) -
            state.albedo[point]) /
           s.sigma;
  }

  template <typename Visit>
  void for_each(const State& state, const Visit& visit) const {
    for (std::size_t p = 0; p < points_.size(); ++p)
      for (const PhotometricSample& s : points_[p].samples) visit(p, s, residual(state, p, s));
  }

  void set_up(ceres::LossFunction* loss, State& state, ceres::Problem& problem,
              ceres::ParameterBlockOrdering& order) const {
    for (std::size_t p = 0; p < points_.size(); ++p) {
      for (const PhotometricSample& s : points_[p].samples)
        problem.AddResidualBlock(new Residual(s), loss, &state.gain[std::size_t(s.view)].x,
                                 &state.albedo[p].x,
                                 &state.vignetting[std::size_t(lens_[std::size_t(s.view)])]);
      order.AddElementToGroup(&state.albedo[p].x, 0);
    }
    auto* gauge = new ceres::DynamicAutoDiffCostFunction<Gauge, 12>(new Gauge{int(views_.size())});
    std::vector<double*> gains;
    for (const std::size_t view : views_) {
      gauge->AddParameterBlock(3);
      gains.push_back(&state.gain[view].x);
      order.AddElementToGroup(gains.back(), 1);
    }
    gauge->SetNumResiduals(3);
    problem.AddResidualBlock(gauge, nullptr, gains);
    for (std::size_t l = 0; l < state.vignetting.size(); ++l) {
      double* v = &state.vignetting[l];
      if (!problem.HasParameterBlock(v)) continue;
      order.AddElementToGroup(v, 1);
      problem.SetParameterLowerBound(v, 0, kLeastVignetting);
      problem.SetParameterUpperBound(v, 0, kMostVignetting);
      if (!state.vignetting_free[l]) problem.SetParameterBlockConstant(v);
    }
  }

  static void solve(const ceres::ParameterBlockOrdering& order, ceres::Problem& problem) {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_SCHUR;
    // Of its own: Ceres takes out what is constant.
    options.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>(order);
    options.max_num_iterations = kIterations;
    options.function_tolerance = kSettled;
    options.num_threads = 1;  // sums are then the same in every run
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (!summary.IsSolutionUsable())
      throw Error(concat("the gains of the views were not found (", summary.message, "); use ",
                         option_word("photometric", "off")));
  }

  const std::vector<PhotometricPoint>& points_;
  const std::vector<int>& lens_;
  const std::vector<bool>& used_;
  const Progress& progress_;
  std::vector<std::size_t> views_;
  double width_ = kFirstWidth;
};

/// Median, over samples and channels, of the deviation of a logarithm from the point's median.
double disagreement(const std::vector<PhotometricPoint>& points,
                    const std::vector<int>& lens_of_view, const State& state, int* count) {
  std::vector<double> all;
  for (const PhotometricPoint& p : points)
    for (int c = 0; c < 3; ++c) {
      std::vector<double> values;
      for (const PhotometricSample& s : p.samples) {
        const double v = state.vignetting[std::size_t(lens_of_view[std::size_t(s.view)])];
        values.push_back(std::log(s.colour[c]) - state.gain[std::size_t(s.view)][c] -
                         std::log(1 - v * s.radius2));
      }
      const double middle = median(values);
      for (const double value : values) all.push_back(std::abs(value - middle));
    }
  *count = int(all.size() / 3);
  return all.empty() ? 0 : median(all);
}

/// Before any view was compared: equal gains, little vignetting, and albedo as the views show it.
State start_state(const std::vector<PhotometricPoint>& points, std::size_t views,
                  std::size_t lenses) {
  State start{std::vector<glm::dvec3>(views, glm::dvec3(0)),
              {},
              std::vector<double>(lenses, 0.05),
              std::vector<bool>(lenses, true)};
  for (const PhotometricPoint& p : points) {
    glm::dvec3 sum(0);
    for (const PhotometricSample& s : p.samples) sum += logarithm(s.colour);
    start.albedo.push_back(sum / double(p.samples.size()));
  }
  return start;
}

double deviation(const Eigen::MatrixXd& covariance, Eigen::Index i) {
  return std::sqrt(std::max(0.0, covariance(i, i)));
}

/// Solves for `state`; vignetting that is not told from none is none, and the rest is solved once
/// more. Returns the covariance of the `gains` parameters of gains and of the vignetting.
Eigen::MatrixXd solve_with_significant_vignetting(Solver& solver, const PhotometricOptions& options,
                                                  Eigen::Index gains, State& state,
                                                  std::vector<double>& vignetting_sigma) {
  solver.run(state);
  const Eigen::MatrixXd covariance = solver.covariance(state);
  bool again = false;
  for (std::size_t l = 0; l < state.vignetting.size(); ++l) {
    vignetting_sigma[l] = deviation(covariance, gains + Eigen::Index(l));
    if (state.vignetting[l] >
        std::max(kVignettingSigmas * vignetting_sigma[l], options.least_vignetting))
      continue;
    state.vignetting[l] = vignetting_sigma[l] = 0;
    state.vignetting_free[l] = false;
    again = true;
  }
  if (!again) return covariance;
  solver.run(state);
  return solver.covariance(state);
}

/// Writes the gains of the `used` views with their deviations, and how large they are in all.
void take_gains(const State& state, const std::vector<bool>& used,
                const Eigen::MatrixXd& covariance, PhotometricCalibration& out) {
  Eigen::Index column = 0;
  double squares = 0, normalised = 0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    ViewGain& view = out.views[i];
    view.solved = true;
    view.gain = glm::exp(state.gain[i]);
    for (int c = 0; c < 3; ++c, ++column) {
      view.sigma[c] = deviation(covariance, column);
      squares += state.gain[i][c] * state.gain[i][c];
      normalised += std::pow(state.gain[i][c] / std::max(view.sigma[c], 1e-6), 2);
    }
  }
  out.rms_gain = std::sqrt(squares / double(column));
  out.rms_sigmas = std::sqrt(normalised / double(column));
}

/// With a place for each view and lens, nothing solved yet. Checks the samples.
PhotometricCalibration unsolved(const std::vector<PhotometricPoint>& points,
                                const std::vector<int>& lens_of_view) {
  const std::size_t count = lens_of_view.size();
  PhotometricCalibration out;
  out.views.resize(count);
  for (const int lens : lens_of_view) out.lens_count = std::max(out.lens_count, lens + 1);
  out.vignetting.assign(std::size_t(out.lens_count), 0);
  out.vignetting_sigma.assign(std::size_t(out.lens_count), 0);
  for (const PhotometricPoint& p : points)
    for (const PhotometricSample& s : p.samples) {
      PHOTOHULL_CHECK(s.view >= 0 && std::size_t(s.view) < count);
      PHOTOHULL_CHECK(glm::all(glm::greaterThan(s.colour, glm::dvec3(0))));
      PHOTOHULL_CHECK(glm::all(glm::greaterThan(s.sigma, glm::dvec3(0))));
      ++out.views[std::size_t(s.view)].samples;
    }
  return out;
}

}  // namespace

void PhotometricOptions::validate() const {
  if (least_samples < 3 || least_samples > 1000000)
    throw UsageError(concat("least_samples must lie in [3, 1e6], not ", least_samples));
  if (!(held_out >= 0.05 && held_out <= 0.5))
    throw UsageError(concat("held_out must lie in [0.05, 0.5], not ", held_out));
  if (!(least_gain >= 0)) throw UsageError(concat("least_gain must be >= 0, not ", least_gain));
  if (!(least_vignetting >= 0))
    throw UsageError(concat("least_vignetting must be >= 0, not ", least_vignetting));
  if (!(least_sigmas >= 0))
    throw UsageError(concat("least_sigmas must be >= 0, not ", least_sigmas));
  if (!(least_profit >= 0 && least_profit < 1))
    throw UsageError(concat("least_profit must lie in [0, 1), not ", least_profit));
}

PhotometricCalibration calibrate_photometric(const std::vector<PhotometricPoint>& all_points,
                                             const std::vector<int>& lens_of_view,
                                             const PhotometricOptions& options,
                                             const Progress& progress) {
  options.validate();
  const std::size_t count = lens_of_view.size();
  PhotometricCalibration out = unsolved(all_points, lens_of_view);
  // Every so many points only judge.
  const auto every = std::size_t(std::lround(1 / options.held_out));
  std::vector<PhotometricPoint> points, judges;
  for (std::size_t i = 0; i < all_points.size(); ++i)
    (i % every == every - 1 ? judges : points).push_back(all_points[i]);
  const std::vector<bool> used = connected_views(points, count, options.least_samples);
  if (std::count(used.begin(), used.end(), true) < 2) return out;
  points = keep_used(points, used);
  judges = keep_used(judges, used);

  State start = start_state(points, count, std::size_t(out.lens_count));
  State state = start;
  Solver solver(points, lens_of_view, used, progress);
  const Eigen::Index gains = 3 * Eigen::Index(std::count(used.begin(), used.end(), true));
  const Eigen::MatrixXd covariance =
      solve_with_significant_vignetting(solver, options, gains, state, out.vignetting_sigma);

  out.solved = true;
  out.points = int(points.size());
  take_gains(state, used, covariance, out);
  for (const PhotometricPoint& p : points) out.samples += int(p.samples.size());
  out.vignetting = state.vignetting;
  for (double& v : start.vignetting) v = 0;
  out.disagreement_before = disagreement(judges, lens_of_view, start, &out.held_out_samples);
  out.disagreement_after = disagreement(judges, lens_of_view, state, &out.held_out_samples);
  const bool vignetting =
      std::any_of(out.vignetting.begin(), out.vignetting.end(), [](double v) { return v > 0; });
  out.significant =
      vignetting || (out.rms_gain > options.least_gain && out.rms_sigmas > options.least_sigmas);
  out.pays = out.significant && out.held_out_samples > 0 &&
             out.disagreement_after < (1 - options.least_profit) * out.disagreement_before;
  return out;
}

}  // namespace photohull

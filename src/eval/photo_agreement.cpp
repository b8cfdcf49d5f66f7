// Based on: M. Waechter, M. Beljan, S. Fuhrmann, N. Moehrle, J. Kopf, M. Goesele, Virtual
// rephotography: novel view prediction error for 3D reconstruction, ACM TOG 2017.
#include "eval/photo_agreement.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/error.h"
#include "core/option_word.h"
#include "eval/window_agreement.h"
#include "photo/noise.h"

namespace photohull::eval {
namespace {

constexpr double kTexture = 3;  // standard deviations of noise
constexpr int kForeground = 128;
constexpr const char* kWindows = "an odd number of pixels from 3 to 63";
constexpr float kKnown = 0.999f;  // alpha

std::optional<double> ratio(double part, double whole) {
  return whole > 0 ? std::optional<double>(part / whole) : std::nullopt;
}

/// Variance below which a window of the photograph tells nothing.
double texture_floor(const ColourImage& photo) {
  const double rounding = 1.0 / 255 / std::sqrt(12.0);
  const double sigma = kTexture * std::max(estimate_image_noise(photo), rounding);
  return sigma * sigma;
}

void check_lists(std::size_t views, std::span<const std::size_t> held_out,
                 std::span<const std::size_t> lenders) {
  if (held_out.empty()) throw UsageError("no photograph is held out to judge by");
  if (lenders.empty())
    throw UsageError("all photographs are held out: none is left to lend colour; hold out fewer");
  for (const std::size_t i : held_out) {
    PHOTOHULL_CHECK_OP(i, <, views);
    if (std::find(lenders.begin(), lenders.end(), i) != lenders.end())
      throw UsageError(concat("view ", i, " is held out and lends colour: it can only do one"));
  }
  for (const std::size_t i : lenders) PHOTOHULL_CHECK_OP(i, <, views);
}

/// Calls work(first, last, score) for the pixels of each row, in parallel, and adds the scores in
/// the rows' order.
template <typename Work>
void add_rows(const ColourImage& image, PhotoScore& total, const Work& work) {
  std::vector<PhotoScore> rows(static_cast<std::size_t>(image.height));
  const auto width = std::size_t(image.width);
  tbb::parallel_for(std::size_t(0), rows.size(),
                    [&](std::size_t y) { work(y * width, (y + 1) * width, rows[y]); });
  for (const PhotoScore& row : rows) total.add(row);
}

glm::vec4 pixel(const ColourImage& image, std::size_t i) {
  const auto width = std::size_t(image.width);
  return image.linear(int(i % width), int(i / width));
}

bool is_known(const ColourImage& image, std::size_t i) {
  return !image.has_alpha || pixel(image, i).a >= kKnown;
}

/// Pixels that the mask covers by half or more, of those that were photographed.
std::vector<std::uint8_t> foreground_of(const PreparedView& view, PhotoScore& score) {
  std::vector<std::uint8_t> out(std::size_t(view.image.width) * std::size_t(view.image.height), 0);
  score.masked = !view.mask.empty();
  add_rows(view.image, score, [&](std::size_t first, std::size_t last, PhotoScore& row) {
    for (std::size_t i = first; i < last; ++i) {
      if (!is_known(view.image, i)) continue;
      ++row.pixels;
      out[i] = view.mask.empty() || view.mask.coverage[i] >= kForeground;
      row.foreground += out[i];
    }
  });
  return out;
}

glm::vec3 encoded(const glm::vec3& linear) {
  const auto one = [](float c) { return float(srgb_from_linear(std::clamp(double(c), 0.0, 1.0))); };
  return {one(linear.r), one(linear.g), one(linear.b)};
}

/// Coverage of the photograph by the prediction and the difference of their colours.
void count_pixels(const PreparedView& view, const PhotoMaps& maps, PhotoScore& score) {
  add_rows(view.image, score, [&](std::size_t first, std::size_t last, PhotoScore& row) {
    for (std::size_t i = first; i < last; ++i) {
      const PixelState state = maps.prediction.state[i];
      if (state == PixelState::kMiss || !is_known(view.image, i)) continue;
      ++row.projected;
      if (!maps.foreground[i]) continue;
      ++row.covered;
      if (state != PixelState::kLit) continue;
      ++row.predicted;
      const glm::dvec3 d(encoded(maps.prediction.colour[i]) -
                         encoded(glm::vec3(pixel(view.image, i))));
      row.squared_sum += glm::dot(d, d) / 3;
      row.absolute_sum += (std::abs(d.x) + std::abs(d.y) + std::abs(d.z)) / 3;
    }
  });
}

PicturePair pair_of(const PreparedView& view, const PhotoMaps& maps) {
  PicturePair pair{view.image.width, view.image.height, {}, {}, maps.foreground, {}};
  const std::size_t size = maps.foreground.size();
  pair.photo.resize(size), pair.prediction.resize(size), pair.predicted.resize(size);
  tbb::parallel_for(std::size_t(0), size, [&](std::size_t i) {
    pair.predicted[i] = maps.prediction.state[i] == PixelState::kLit;
    if (!pair.counts[i]) return;
    pair.photo[i] = glm::sqrt(glm::max(glm::vec3(pixel(view.image, i)), glm::vec3(0)));
    pair.prediction[i] = glm::sqrt(maps.prediction.colour[i]);
  });
  return pair;
}

void add_scores(const PhotoMaps& maps, PhotoScore& score) {
  for (std::size_t i = 0; i < maps.scores.size(); ++i) {
    if (std::isnan(maps.scores[i])) continue;
    ++score.judged;
    score.judged_predicted += maps.prediction.state[i] == PixelState::kLit;
    score.score_sum += double(maps.scores[i]);
  }
}

PhotoScore judge_view(const PreparedView& view, const PhotoOptions& options,
                      const std::function<void()>& row_done, PhotoMaps& maps) {
  PhotoScore score;
  score.view = view.name;
  maps.foreground = foreground_of(view, score);
  count_pixels(view, maps, score);
  maps.scores =
      window_agreement(pair_of(view, maps), options.window, texture_floor(view.image), row_done);
  add_scores(maps, score);
  return score;
}

void add_warnings(PhotoAgreement& result) {
  const auto warn = [&](const std::string& text) { result.warnings.push_back(text); };
  std::string unmasked, unseen, plain;
  for (const PhotoScore& v : result.views) {
    const auto list = [&](std::string& names) { names += (names.empty() ? "" : ", ") + v.view; };
    if (!v.masked) list(unmasked);
    if (v.projected == 0) list(unseen);
    if (v.judged == 0) list(plain);
  }
  if (!unmasked.empty())
    warn(concat("no mask tells the object from the background in ", unmasked,
                ": all of the photograph counts as foreground there"));
  if (!unseen.empty()) warn(concat("the mesh is not in sight of ", unseen));
  if (!plain.empty())
    warn(concat("no window of the foreground holds texture beyond noise in ", plain));
  if (result.all.predicted == 0)
    warn("no lending view sees what the held-out ones see of the mesh: nothing is predicted");
}

}  // namespace

void describe(Described& to, PhotoOptions& o) {
  describe(to, o.predict);
  to.number("window", &o.window, from_to(3, 63), "pixels", "edge of the windows compared, pixels")
      .expects = kWindows;
}

void PhotoOptions::validate() const {
  predict.validate();
  check_options(*this);
  if (window % 2 == 0)
    throw UsageError(concat(option_word("window", window), ": expected ", kWindows));
}

std::optional<double> PhotoScore::zncc() const { return ratio(score_sum, double(judged)); }
std::optional<double> PhotoScore::zncc_predicted() const {
  return ratio(score_sum, double(judged_predicted));
}
std::optional<double> PhotoScore::psnr() const {
  if (predicted == 0) return std::nullopt;
  // Pictures equal to the last bit would have none; half a step of 8 bits stands for them.
  const double least = std::pow(0.5 / 255, 2);
  return -10 * std::log10(std::max(squared_sum / double(predicted), least));
}
std::optional<double> PhotoScore::mean_difference() const {
  return ratio(absolute_sum, double(predicted));
}
std::optional<double> PhotoScore::coverage() const {
  return ratio(double(covered), double(foreground));
}
std::optional<double> PhotoScore::predicted_share() const {
  return ratio(double(predicted), double(foreground));
}
std::optional<double> PhotoScore::excess() const {
  return masked ? ratio(double(projected - covered), double(projected)) : std::nullopt;
}
std::optional<double> PhotoScore::silhouette_iou() const {
  return masked ? ratio(double(covered), double(projected + foreground - covered)) : std::nullopt;
}

void PhotoScore::add(const PhotoScore& o) {
  pixels += o.pixels, foreground += o.foreground, projected += o.projected;
  covered += o.covered, predicted += o.predicted;
  judged += o.judged, judged_predicted += o.judged_predicted;
  score_sum += o.score_sum, squared_sum += o.squared_sum, absolute_sum += o.absolute_sum;
}

PhotoAgreement judge_by_photographs(const TriMesh& mesh, std::span<const PreparedView> views,
                                    std::span<const std::size_t> held_out,
                                    std::span<const std::size_t> lenders,
                                    const PhotoOptions& options, Progress* given,
                                    PhotoMaps* worst) {
  Progress silent;
  Progress& progress = given ? *given : silent;
  options.validate();
  check_lists(views.size(), held_out, lenders);
  const RayScene rays(mesh);
  PhotoAgreement result;
  result.options = options;
  result.lenders = lenders.size();
  result.all.masked = true;
  std::int64_t rows = 0, done = 0;
  for (const std::size_t i : held_out) rows += 2 * views[i].image.height;
  std::mutex mutex;  // Progress need not be thread-safe
  const auto row_done = [&] {
    progress.check_cancelled();
    const std::scoped_lock lock(mutex);
    progress.update(double(++done) / double(rows));
  };
  for (const std::size_t i : held_out) {
    PhotoMaps maps;
    maps.view = i;
    maps.prediction =
        predict_photo(mesh, rays, views[i].camera, views, lenders, options.predict, row_done);
    result.views.push_back(judge_view(views[i], options, row_done, maps));
    const PhotoScore& score = result.views.back();
    result.all.add(score);
    result.all.masked = result.all.masked && score.masked;
    if (!score.zncc() || (result.worst && *score.zncc() >= *result.views[*result.worst].zncc()))
      continue;
    result.worst = result.views.size() - 1;
    if (worst) *worst = std::move(maps);
  }
  if (result.all.projected == 0)
    throw Error(
        "no held-out view sees the mesh: it must be in the world coordinates of the photographs' "
        "cameras");
  add_warnings(result);
  return result;
}

}  // namespace photohull::eval

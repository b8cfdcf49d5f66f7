#include "io/spread_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "core/option_word.h"
#include "io/natural_less.h"
#include "io/text_file.h"

namespace photohull::io {
namespace {

constexpr std::string_view kPrefix = "spread:";
constexpr std::int64_t kFewest = 2;
/// Weight of the guess against one view's axis where the axes are parallel and meet nowhere.
constexpr double kGuess = 1e-3;

/// What a view shows: its place about the middle, and the direction of its axis.
using Feature = std::array<double, 6>;

double squared_distance(const Feature& a, const Feature& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

/// The point with the least sum of squared distances from the optical axes; where these are
/// parallel, one before the middle of the cameras, as far as these are apart.
glm::dvec3 middle_of_axes(const std::vector<SourceView>& views) {
  const double n = double(views.size());
  glm::dvec3 centre(0), forward(0), right_side(0);
  for (const SourceView& view : views) {
    centre += view.camera.center() / n;
    forward += view.camera.forward() / n;
  }
  double apart = 0;
  glm::dmat3 normal(0.0);
  for (const SourceView& view : views) {
    const glm::dvec3 c = view.camera.center(), d = view.camera.forward();
    const glm::dmat3 across = glm::dmat3(1.0) - glm::outerProduct(d, d);
    normal += across;
    right_side += across * c;
    apart += glm::dot(c - centre, c - centre) / n;
  }
  const glm::dvec3 guess = centre + std::sqrt(apart) * forward;
  return glm::inverse(normal + glm::dmat3(kGuess)) * (right_side + kGuess * guess);
}

bool faces(const Camera& camera, const Box& box) {
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                       corner & 4 ? box.max.z : box.min.z);
    if (camera.to_camera(p).z > 0) return true;
  }
  return false;
}

double median_distance(const std::vector<SourceView>& views, const glm::dvec3& middle) {
  std::vector<double> distances;
  for (const SourceView& view : views)
    distances.push_back(glm::length(view.camera.center() - middle));
  const auto half = distances.begin() + std::ptrdiff_t(distances.size() / 2);
  std::nth_element(distances.begin(), half, distances.end());
  return std::max(*half, std::numeric_limits<double>::min());
}

Feature feature_of(const Camera& camera, const glm::dvec3& middle, double distance) {
  const glm::dvec3 p = (camera.center() - middle) / distance, axis = camera.forward();
  const glm::dvec3 place = 2.0 / (1 + glm::length(p)) * p;
  return {place.x, place.y, place.z, axis.x, axis.y, axis.z};
}

std::vector<std::size_t> by_name(const std::vector<SourceView>& views) {
  std::vector<std::size_t> order(views.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return natural_less(views[a].name, views[b].name);
  });
  return order;
}

}  // namespace

std::optional<std::size_t> parse_spread(const std::string& selection) {
  if (!selection.starts_with(kPrefix)) return std::nullopt;
  const auto count = parse_integer(std::string_view(selection).substr(kPrefix.size()));
  if (!count || *count < kFewest)
    throw UsageError(concat(option_word("views", selection), ": expected ", kPrefix,
                            "N with a number of views N of ", kFewest, " or more"));
  return std::size_t(*count);
}

std::vector<std::size_t> spread_views(const std::vector<SourceView>& views,
                                      const std::optional<Box>& box, std::size_t count) {
  const std::vector<std::size_t> order = by_name(views);
  std::vector<std::size_t> chosen;
  if (count >= views.size()) {
    chosen.resize(views.size());
    std::iota(chosen.begin(), chosen.end(), std::size_t(0));
    return chosen;
  }
  const glm::dvec3 middle = box ? box->center() : middle_of_axes(views);
  const double distance = median_distance(views, middle);
  std::vector<Feature> features;
  Feature mean{};
  for (const std::size_t i : order) {
    features.push_back(feature_of(views[i].camera, middle, distance));
    for (std::size_t k = 0; k < mean.size(); ++k)
      mean[k] += features.back()[k] / double(views.size());
  }
  // The first is the one that is most unlike the mean.
  std::vector<double> apart;
  for (const Feature& feature : features) apart.push_back(squared_distance(feature, mean));
  std::vector<int> rank;  // 2: faces the box; 1: does not; 0: taken
  for (const std::size_t i : order) rank.push_back(!box || faces(views[i].camera, *box) ? 2 : 1);
  while (chosen.size() < count) {
    std::size_t next = 0;
    for (std::size_t i = 1; i < order.size(); ++i)
      if (rank[i] > rank[next] || (rank[i] == rank[next] && apart[i] > apart[next])) next = i;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const double now = squared_distance(features[i], features[next]);
      apart[i] = chosen.empty() ? now : std::min(apart[i], now);
    }
    rank[next] = 0;
    chosen.push_back(order[next]);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace photohull::io

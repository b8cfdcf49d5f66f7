// Estimates the background's colours from the frame's pixels, and where the object's begin.
//
// Colours are counted in cells of a cube, so that any shape of distribution will do: black with a
// dim cloth in it, a grey wall, two walls. Every colour's Euclidean distance to the nearest
// background cell comes from three passes along the axes; the levels come from the histogram of
// distances over all pixels: Otsu, "A threshold selection method from gray-level histograms", 1979
// [Otsu1979], and the valley below that threshold.
#include "masks/background.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <numeric>

#include "core/error.h"
#include "masks/background_cells.h"

namespace photohull {
namespace {

constexpr int kCells = BackgroundModel::kCells;
constexpr std::size_t kCellCount = std::size_t(kCells) * kCells * kCells;

constexpr double kFrameShare = 0.0125;  ///< of the shorter side: width of the frame's pixels
constexpr double kSamples = 20000;      ///< about so many pixels of an image are counted
constexpr float kKeptMass = 0.99f;      ///< the rarest colours along the frame are left out
constexpr float kLeastDensity = 2e-5f;  ///< five times that of colours spread evenly
constexpr float kLeastRatio = 0.25f;    ///< of a colour's share at the frame to that everywhere
constexpr float kLeastMode = 0.02f;     ///< share of the frame that a separate colour must fill
constexpr int kNoise = 4;               ///< levels; smaller distances are background, surely
constexpr double kLeastObject = 0.002;  ///< share of pixels; below, there is no object

using Counts = std::vector<float>;          ///< per colour cell
using Histogram = std::array<double, 256>;  ///< share of pixels at each distance

struct ColourCounts {
  Counts frame = Counts(kCellCount);
  Counts all = Counts(kCellCount);
};

ColourCounts count_colours(const std::vector<const ColourImage*>& images) {
  ColourCounts counts;
  for (const ColourImage* image : images) {
    const int w = image->width, h = image->height;
    const int step = std::max(1, int(std::sqrt(double(w) * h / kSamples)));
    const int ring =
        std::clamp(int(std::lround(kFrameShare * std::min(w, h))), 1, (std::min(w, h) + 1) / 2);
    const auto at_frame = [&](int, std::size_t cell) { counts.frame[cell] += 1; };
    const auto anywhere = [&](int, std::size_t cell) { counts.all[cell] += 1; };
    for (int y = 0; y < h; ++y) {
      if (y < ring || y >= h - ring) {
        for_each_cell(*image, 0, w, y, 2, at_frame);
      } else {
        for_each_cell(*image, 0, ring, y, 2, at_frame);
        for_each_cell(*image, w - ring, w, y, 2, at_frame);
      }
      if (y % step == step / 2) for_each_cell(*image, step / 2, w, y, step, anywhere);
    }
  }
  return counts;
}

/// Shares of the cells, each averaged over 3^3 cells; the cube's faces reflect, so that black and
/// white keep their share.
Counts density(Counts counts) {
  for (const std::size_t stride : {1, kCells, kCells * kCells}) {
    Counts out = counts;
    for (std::size_t i = 0; i < kCellCount; ++i) {
      const std::size_t k = i / stride % kCells;
      out[i] += counts[k > 0 ? i - stride : i];
      out[i] += counts[k + 1 < kCells ? i + stride : i];
    }
    counts.swap(out);
  }
  const float total = std::accumulate(counts.begin(), counts.end(), 0.0f);
  for (float& c : counts) c /= std::max(total, 1.0f);
  return counts;
}

template <typename Visit>
void for_each_neighbour(std::size_t cell, const Visit& visit) {
  const int c[3] = {int(cell / kCells / kCells), int(cell / kCells % kCells), int(cell % kCells)};
  for (int r = std::max(c[0] - 1, 0); r <= std::min(c[0] + 1, kCells - 1); ++r)
    for (int g = std::max(c[1] - 1, 0); g <= std::min(c[1] + 1, kCells - 1); ++g)
      for (int b = std::max(c[2] - 1, 0); b <= std::min(c[2] + 1, kCells - 1); ++b)
        visit((std::size_t(r) * kCells + std::size_t(g)) * kCells + std::size_t(b));
}

/// Removes groups of touching cells that hold less than kLeastMode of the frame's pixels: patches
/// of objects that the frame cuts.
void keep_modes(std::vector<std::uint8_t>& cells, const Counts& frame) {
  std::vector<std::uint8_t> pending = cells;
  std::vector<std::size_t> group;
  for (std::size_t seed = 0; seed < kCellCount; ++seed) {
    if (!pending[seed]) continue;
    group.assign(1, seed);
    pending[seed] = 0;
    float mass = 0;
    for (std::size_t n = 0; n < group.size(); ++n) {
      mass += frame[group[n]];
      for_each_neighbour(group[n], [&](std::size_t next) {
        if (pending[next]) group.push_back(next);
        pending[next] = 0;
      });
    }
    if (mass < kLeastMode)
      for (const std::size_t cell : group) cells[cell] = 0;
  }
}

/// 1 for the colours of the background.
std::vector<std::uint8_t> background_cells(const ColourCounts& counts) {
  const Counts frame = density(counts.frame), all = density(counts.all);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < kCellCount; ++i)
    if (frame[i] > kLeastDensity && frame[i] > kLeastRatio * all[i]) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return frame[a] > frame[b]; });
  std::vector<std::uint8_t> cells(kCellCount, 0);
  float mass = 0;
  for (const std::size_t i : order) {
    cells[i] = 1;
    mass += frame[i];
    if (mass > kKeptMass) break;
  }
  keep_modes(cells, frame);
  return cells;
}

/// Along one axis of the cube: out[k] = min over j of in[j] + (k - j)^2.
template <std::size_t kStride>
void spread(std::vector<std::uint16_t>& squared) {
  std::vector<std::uint16_t> out(squared.size(), 0xffff);
  for (std::size_t block = 0; block < kCellCount; block += kStride * kCells)
    for (int k = 0; k < kCells; ++k)
      for (int j = 0; j < kCells; ++j) {
        const std::uint16_t* from = &squared[block + std::size_t(j) * kStride];
        std::uint16_t* to = &out[block + std::size_t(k) * kStride];
        const auto add = std::uint16_t((k - j) * (k - j));
        for (std::size_t i = 0; i < kStride; ++i)
          to[i] = std::min<std::uint16_t>(to[i], std::uint16_t(from[i] + add));
      }
  squared.swap(out);
}

std::vector<std::uint8_t> colour_distances(const std::vector<std::uint8_t>& cells) {
  constexpr std::uint16_t kUnreached = 40000;  // leaves room for adding 3 * 63^2
  constexpr double kLevelsPerCell = 256.0 / kCells;
  std::vector<std::uint16_t> squared(kCellCount);
  for (std::size_t i = 0; i < kCellCount; ++i) squared[i] = cells[i] ? 0 : kUnreached;
  spread<1>(squared);
  spread<kCells>(squared);
  spread<std::size_t(kCells) * kCells>(squared);
  std::vector<std::uint8_t> distance(kCellCount);
  for (std::size_t i = 0; i < kCellCount; ++i)
    distance[i] =
        std::uint8_t(std::min(255.0, std::round(kLevelsPerCell * std::sqrt(double(squared[i])))));
  return distance;
}

Histogram histogram(const std::vector<std::uint8_t>& distance, const Counts& counts) {
  Histogram h{};
  double total = 0;
  for (std::size_t i = 0; i < kCellCount; ++i) {
    h[distance[i]] += counts[i];
    total += counts[i];
  }
  for (double& share : h) share /= std::max(total, 1.0);
  return h;
}

/// Threshold that splits a histogram best in two.
int otsu_threshold(const Histogram& h) {
  double mean = 0;
  for (int i = 0; i < 256; ++i) mean += i * h[std::size_t(i)];
  double below = 0, moment = 0, best = -1;
  int threshold = 0;
  for (int i = 0; i < 255; ++i) {
    below += h[std::size_t(i)];
    moment += i * h[std::size_t(i)];
    if (below <= 0 || below >= 1) continue;
    const double gap = mean * below - moment;
    const double between = gap * gap / (below * (1 - below));
    if (between > best) {
      best = between;
      threshold = i + 1;
    }
  }
  return threshold;
}

/// Gaussian blur (4 levels) without the background's own peak.
Histogram smoothed(const Histogram& h) {
  Histogram out{};
  for (int i = 0; i < 256; ++i) {
    double weights = 0;
    for (int j = std::max(i - 10, kNoise); j <= std::min(i + 10, 255); ++j) {
      const double w = std::exp(-(i - j) * (i - j) / 32.0);
      out[std::size_t(i)] += w * h[std::size_t(j)];
      weights += w;
    }
    if (weights > 0) out[std::size_t(i)] /= weights;
  }
  return out;
}

double share_from(const Histogram& h, int from) {
  return std::accumulate(h.begin() + from, h.end(), 0.0);
}

/// Strong begins where the valley between background and object does. The separation is low when
/// many pixels lie in the valley, when the frame looks like the middle, and without a second peak.
void choose_levels(const Histogram& all, const Histogram& frame, BackgroundModel& model) {
  const Histogram smooth = smoothed(all);
  const auto end = smooth.begin() + std::max(otsu_threshold(all), kNoise + 1);
  const double least = *std::min_element(smooth.begin() + kNoise, end);
  const auto valley = std::find_if(smooth.begin() + kNoise, end,
                                   [&](double share) { return share <= 1.25 * least; });
  model.strong = std::clamp(int(valley - smooth.begin()), 12, 64);
  model.weak = std::clamp(model.strong / 3, 6, 16);

  const double object = share_from(all, model.weak);
  if (object < kLeastObject) return;
  model.doubt = 1 - share_from(all, model.strong) / object;
  const double unlike_frame = std::max(0.0, 1 - share_from(frame, model.weak) / object);
  const double peak = *std::max_element(smooth.begin() + model.strong, smooth.end());
  model.separation = (1 - model.doubt) * unlike_frame * std::min(1.0, peak / (2 * least));
}

}  // namespace

const std::vector<std::uint8_t>& srgb_of_half() {
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> t(65536);
    for (std::size_t i = 0; i < t.size(); ++i) {
      const float value = glm::unpackHalf1x16(glm::uint16(i));
      if (value > 0)
        t[i] = std::uint8_t(std::lround(255 * srgb_from_linear(std::min(value, 1.0f))));
    }
    return t;
  }();
  return table;
}

BackgroundModel estimate_background(const std::vector<const ColourImage*>& images) {
  const ColourCounts counts = count_colours(images);
  BackgroundModel model;
  model.distance = colour_distances(background_cells(counts));
  choose_levels(histogram(model.distance, counts.all), histogram(model.distance, counts.frame),
                model);
  return model;
}

}  // namespace photohull

#include "pipeline/explained_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace photohull::pipeline {
namespace {

using assess::Place;

constexpr float kDarkened = 0.35f;  // of the photograph's light
constexpr double kTint = 0.6;       // of a square's colour, over the photograph's

/// Nothing: the photograph as it is.
std::optional<std::array<int, 3>> tint_of(Place place) {
  switch (place) {
    case Place::kMissed:
      return {{255, 40, 30}};
    case Place::kDisagreeing:
      return {{255, 140, 0}};
    case Place::kAlone:
      return {{255, 230, 40}};
    case Place::kBare:
      return {{150, 60, 200}};
    case Place::kCut:
    case Place::kBeyond:
      return {{40, 110, 255}};
    case Place::kPlain:
    case Place::kExplained:
      break;
  }
  return {};
}

int wrong_places(const assess::ExplainedView& view) {
  return int(std::count_if(view.places.begin(), view.places.end(), [](const assess::PlaceAt& p) {
    return p.place == Place::kMissed || p.place == Place::kDisagreeing || p.place == Place::kAlone;
  }));
}

std::array<std::uint8_t, 3> encoded(const ColourImage& image, int x, int y, float share) {
  const glm::vec4 light = image.linear(x, y);
  std::array<std::uint8_t, 3> rgb{};
  for (int c = 0; c < 3; ++c)
    rgb[std::size_t(c)] = std::uint8_t(
        std::lround(255 * srgb_from_linear(double(share * std::clamp(light[c], 0.0f, 1.0f)))));
  return rgb;
}

void draw_square(const ColourImage& image, const assess::PlaceAt& place, int step,
                 MissingPicture& picture) {
  if (place.place == Place::kPlain) return;
  const auto tint = tint_of(place.place);
  const int x0 = std::max(0, place.x - step / 2), y0 = std::max(0, place.y - step / 2);
  const int x1 = std::min(x0 + step, image.width), y1 = std::min(y0 + step, image.height);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const auto photo = encoded(image, x, y, 1);
      std::uint8_t* out = &picture.rgb[3 * (std::size_t(y) * std::size_t(image.width) + x)];
      for (std::size_t c = 0; c < 3; ++c)
        out[c] = tint ? std::uint8_t(std::lround(kTint * (*tint)[c] + (1 - kTint) * photo[c]))
                      : photo[c];
    }
}

}  // namespace

MissingPicture draw_explained(std::span<const PreparedView> views,
                              const assess::Explained& explained) {
  const std::vector<assess::ExplainedView>& all = explained.views;
  const auto worst = std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return wrong_places(a) < wrong_places(b);
  });
  if (worst == all.end() || wrong_places(*worst) + worst->told() + worst->count(Place::kBare) == 0)
    return {};
  const PreparedView& view = views[std::size_t(worst - all.begin())];
  const ColourImage& image = view.image;
  MissingPicture picture{{image.width, image.height, {}}, view.name};
  picture.rgb.reserve(3 * std::size_t(image.width) * std::size_t(image.height));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto dark = encoded(image, x, y, kDarkened);
      picture.rgb.insert(picture.rgb.end(), dark.begin(), dark.end());
    }
  for (const assess::PlaceAt& place : worst->places)
    draw_square(image, place, worst->step, picture);
  return picture;
}

}  // namespace photohull::pipeline

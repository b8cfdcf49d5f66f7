#include "pipeline/check_photographs.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/median.h"
#include "render/scene_up.h"

namespace photohull::pipeline {
namespace {

constexpr std::size_t kFewest = 5;               // photographs that have a usual sharpness
constexpr double kBlurred = 0.5;                 // of the usual sharpness
constexpr double kMostExposures = 2;             // ratio between the longest and the shortest
constexpr double kFacing = 45;                   // degrees between a view's axis and the middle
constexpr double kMostFacing = 0.8;              // share of the views
constexpr double kSteepest = 70;                 // degrees above or below the horizon
constexpr double kWideGap = 90, kOneSide = 180;  // degrees of azimuth without a view
constexpr std::size_t kFewestAround = 3;

double radians(double degrees) { return degrees * M_PI / 180; }

/// "a.jpg, b.jpg, c.jpg and 2 more"
std::string named(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, names.size()); ++i)
    text += (i ? ", " : "") + names[i];
  return names.size() > kMost ? concat(text, " and ", names.size() - kMost, " more") : text;
}

std::string check_sharpness(std::span<const PhotoLook> photographs) {
  std::vector<double> known;
  for (const PhotoLook& look : photographs)
    if (look.sharpness > 0) known.push_back(look.sharpness);
  if (known.size() < kFewest) return "";
  const double usual = median(known);
  std::vector<std::string> blurred;
  for (const PhotoLook& look : photographs)
    if (look.sharpness > 0 && look.sharpness < kBlurred * usual) blurred.push_back(look.name);
  if (blurred.empty()) return "";
  return concat(
      blurred.size() == 1 ? "a photograph is" : concat(blurred.size(), " photographs are"),
      " much less sharp than the others (", named(blurred),
      "): moved or out of focus; take them again with a shorter exposure, or leave them "
      "out");
}

std::string check_exposure(std::span<const PhotoLook> photographs) {
  const PhotoLook *least = nullptr, *most = nullptr;
  for (const PhotoLook& look : photographs) {
    if (!(look.exposure > 0)) continue;
    if (!least || look.exposure < least->exposure) least = &look;
    if (!most || look.exposure > most->exposure) most = &look;
  }
  if (!least || most->exposure < kMostExposures * least->exposure) return "";
  return concat("the camera changed its exposure by a factor of ",
                std::round(10 * most->exposure / least->exposure) / 10, " between ", least->name,
                " and ", most->name,
                ": what is dark in one and too bright in another cannot be matched; lock the "
                "exposure, and keep the light as it is");
}

/// A view about the middle, as seen from above.
struct Place {
  double azimuth = 0;  ///< radians
  const SourceView* view = nullptr;
};

/// In the order of their azimuths; nothing where views do not look at one place.
std::vector<Place> places_around(std::span<const SourceView> views, const glm::dvec3& middle,
                                 const glm::dvec3& up) {
  const glm::dvec3 any = std::abs(up.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(up, any)), y = glm::cross(up, x);
  std::vector<Place> places;
  std::size_t facing = 0;
  for (const SourceView& view : views) {
    const glm::dvec3 way = view.camera.center() - middle;
    const double distance = glm::length(way);
    if (!(distance > 0) ||
        glm::dot(view.camera.forward(), way) > -distance * std::cos(radians(kFacing)))
      continue;
    ++facing;
    if (std::abs(glm::dot(way, up)) < distance * std::sin(radians(kSteepest)))
      places.push_back({std::atan2(glm::dot(way, y), glm::dot(way, x)), &view});
  }
  if (double(facing) < kMostFacing * double(views.size()) || 2 * places.size() < facing) return {};
  std::ranges::sort(places, {}, &Place::azimuth);
  return places;
}

std::string check_coverage(std::span<const SourceView> views, const glm::dvec3& middle,
                           const glm::dvec3& up) {
  const std::vector<Place> places = places_around(views, middle, up);
  if (places.size() < kFewestAround) return "";
  double gap = 0;
  const SourceView *from = nullptr, *to = nullptr;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const bool last = i + 1 == places.size();
    const Place& next = places[last ? 0 : i + 1];
    const double turn = next.azimuth - places[i].azimuth + (last ? 2 * M_PI : 0);
    if (turn > gap) gap = turn, from = places[i].view, to = next.view;
  }
  const long degrees = std::lround(gap * 180 / M_PI);
  if (degrees < kWideGap) return "";
  if (degrees >= kOneSide)
    return concat("all photographs were taken from one side: as seen from above they span ",
                  360 - degrees, " degrees, from ", to->name, " to ", from->name,
                  "; what lies behind is not known, unless you photograph it, too");
  return concat("as seen from above no photograph was taken over ", degrees, " degrees, between ",
                from->name, " and ", to->name, ": photograph that side, too");
}

}  // namespace

std::vector<std::string> check_photographs(std::span<const PhotoLook> photographs,
                                           std::span<const SourceView> views,
                                           const glm::dvec3& middle,
                                           const std::optional<glm::dvec3>& up) {
  std::vector<Camera> cameras;
  for (const SourceView& view : views) cameras.push_back(view.camera);
  std::vector<std::string> warnings;
  for (const std::string& text :
       {check_sharpness(photographs), check_exposure(photographs),
        check_coverage(views, middle, up ? *up : render::scene_up(cameras, middle))})
    if (!text.empty()) warnings.push_back(text);
  return warnings;
}

}  // namespace photohull::pipeline

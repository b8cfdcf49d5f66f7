#include "pipeline/checks.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "core/median.h"
#include "core/option_word.h"
#include "core/too_many_voxels.h"
#include "masks/silhouette.h"
#include "pipeline/memory.h"

namespace photohull::pipeline {
namespace {

constexpr int kProbes = 12;              // probe points along each side of the box
constexpr double kLeastBaseline = 1e-3;  // of the distance to the box
constexpr double kLeastPixels = 4;       // that the box covers in some view

template <typename F>
void for_each_probe(const Box& box, F&& f) {
  for (int i = 0; i < kProbes; ++i)
    for (int j = 0; j < kProbes; ++j)
      for (int k = 0; k < kProbes; ++k)
        f(box.min + box.size() * (glm::dvec3(i, j, k) + 0.5) / double(kProbes));
}

/// To two digits.
double rounded(double value) {
  if (!(value > 0)) return value;
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return std::round(value / unit) * unit;
}

/// Pixels between the farthest of the box's corners that lie before the camera; infinite where not
/// all do, for the camera stands within or close by.
double extent_in_picture(const Camera& camera, const Box& box) {
  glm::dvec2 low(INFINITY), high(-INFINITY);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 which(corner & 1, corner >> 1 & 1, corner >> 2);
    const auto pixel = camera.project(box.min + which * box.size());
    if (!pixel) return INFINITY;
    low = glm::min(low, *pixel), high = glm::max(high, *pixel);
  }
  return glm::distance(low, high);
}

bool sees(const Camera& camera, const Box& box) {
  bool seen = false;
  for_each_probe(box, [&](const glm::dvec3& p) {
    if (seen) return;
    const auto pixel = camera.project(p);
    seen = pixel && camera.on_image(*pixel);
  });
  return seen;
}

bool removes(const carving::Silhouette& silhouette, const Camera& camera, const glm::dvec3& p) {
  const auto pixel = camera.project(p);
  return silhouette.distance && pixel && camera.on_image(*pixel) &&
         interpolated(*silhouette.distance, *pixel) > 0;
}

}  // namespace

std::vector<std::string> check_box(const Box& box, const std::string& source,
                                   std::span<const SourceView> views) {
  const glm::dvec3 size = box.size();
  if (!(size.x > 0 && size.y > 0 && size.z > 0))
    throw Error(concat("the box from ", source, " has no volume: its sides are ", size.x, ", ",
                       size.y, ", ", size.z, "; give ",
                       option_word("box", "\"x0 y0 z0 x1 y1 z1\"")));
  std::vector<std::string> blind;
  for (const SourceView& view : views)
    if (!sees(view.camera, box)) blind.push_back(view.name);
  if (blind.size() == views.size())
    throw Error(concat("no camera has the box from ", source,
                       " on its image: check the box's units and the poses' direction "
                       "(photohull info shows both)"));
  if (blind.empty()) return {};
  return {concat(blind.size(), " of ", views.size(),
                 " cameras do not have the box on their image: ", blind.front(),
                 blind.size() > 1 ? ", ..." : "")};
}

std::optional<std::string> hopeless_setup(const Box& box, const std::string& source,
                                          std::span<const SourceView> views) {
  std::vector<double> distances;
  double apart = 0, pixels = 0;
  for (const SourceView& view : views) {
    const glm::dvec3 centre = view.camera.center();
    distances.push_back(glm::distance(centre, box.center()));
    apart = std::max(apart, glm::distance(centre, views.front().camera.center()));
    pixels = std::max(pixels, extent_in_picture(view.camera, box));
  }
  const double distance = median(distances);
  if (views.size() > 1 && apart < kLeastBaseline * distance)
    return concat("all ", views.size(),
                  " cameras stand in one place: depth shows only from different ones; check the "
                  "translations of the poses (photohull info shows them)");
  if (pixels >= kLeastPixels) return {};
  const bool given = source == option_word("box");
  return concat(
      "the box from ", source, " is ", rounded(box.diagonal()), " across, the cameras stand ",
      rounded(distance), " away from it, and it covers ", rounded(pixels),
      " pixels of any photograph at most: ",
      given ? concat("make ", option_word("box"), " larger, or give it in the cameras' units")
            : concat("are its units other than the cameras' (millimetres and metres)? Give ",
                     option_word("box"), " in the cameras' units, or let it be found (",
                     option_word("box", "auto"), ")"));
}

std::size_t cameras_within(const Box& box, std::span<const SourceView> views) {
  return std::size_t(std::count_if(views.begin(), views.end(), [&](const SourceView& view) {
    return box.contains(view.camera.center());
  }));
}

std::string sentence_about_cameras(const Box& box, const std::string& source,
                                   std::span<const SourceView> views) {
  const std::size_t within = cameras_within(box, views);
  if (within == 0) return "";
  return concat("; ", within, " of ", views.size(), " cameras stand inside the box from ", source,
                ": unless it is a room, make ", option_word("box"),
                " smaller, or check that the poses are world-to-camera");
}

void check_cameras_outside(const Box& box, const std::string& source,
                           std::span<const SourceView> views) {
  for (const SourceView& view : views)
    if (box.contains(view.camera.center()))
      throw Error(concat("camera ", view.name, " stands inside the box from ", source,
                         ", where silhouettes tell nothing: make ", option_word("box"),
                         " smaller, check that the poses are world-to-camera, or, for a room "
                         "photographed from within, give ",
                         option_word("masks", "none"), " and ", option_word("method", "refine")));
}

void check_memory(const MemoryNeed& need, std::int64_t limit) {
  if (need.bytes <= limit) return;
  const bool apart = memory_text(need.bytes) != memory_text(limit);
  const auto text = [&](std::int64_t size) {
    return apart ? memory_text(size) : concat(size >> 20, " MiB");
  };
  const double room =
      double(limit - need.fixed) / double(std::max<std::int64_t>(need.bytes - need.fixed, 1));
  throw TooManyVoxels(
      concat("this job would take about ", text(need.bytes), " of memory, but may take ",
             text(limit), " (", option_word("max_memory"), ")"),
      concat("lower ", option_word("resolution"), " or ", option_word("image_scale"),
             ", or use fewer ", option_word("views")),
      need.voxel_size, room);
}

std::string explain_empty_hull(const Box& box, std::span<const PreparedView> views,
                               std::span<const carving::Silhouette> silhouettes,
                               double voxel_size) {
  std::vector<int> removed(views.size());
  int left = 0;
  for_each_probe(box, [&](const glm::dvec3& p) {
    bool stays = true;
    for (std::size_t i = 0; i < views.size(); ++i)
      if (removes(silhouettes[i], views[i].camera, p)) {
        ++removed[i];
        stays = false;
      }
    left += stays;
  });
  if (left > 0)
    return concat("nothing is left of the box: voxels of ", voxel_size,
                  " are too large for what the silhouettes leave; raise ",
                  option_word("resolution"));
  std::vector<std::size_t> order(views.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return removed[a] > removed[b]; });
  std::string text = "nothing is left of the box: the silhouettes have no common space. ";
  for (std::size_t i = 0; i < std::min<std::size_t>(3, order.size()); ++i)
    text += concat(i ? ", " : "Alone, ", views[order[i]].name, " removes ",
                   std::lround(100 * removed[order[i]] / std::pow(kProbes, 3)), " %");
  return text + ". Check the masks (white is the object), the box and the cameras";
}

}  // namespace photohull::pipeline

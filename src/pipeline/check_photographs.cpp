#include "pipeline/check_photographs.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/median.h"

namespace photohull::pipeline {
namespace {

constexpr std::size_t kFewest = 5;    // photographs that have a usual sharpness
constexpr double kBlurred = 0.5;      // of the usual sharpness
constexpr double kMostExposures = 2;  // ratio between the longest and the shortest

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

}  // namespace

std::vector<std::string> check_photographs(std::span<const PhotoLook> photographs,
                                           const Coverage& coverage, const std::string& picture) {
  std::vector<std::string> warnings;
  for (const std::string& text : {check_sharpness(photographs), check_exposure(photographs),
                                  coverage_warning(coverage, picture)})
    if (!text.empty()) warnings.push_back(text);
  return warnings;
}

}  // namespace photohull::pipeline

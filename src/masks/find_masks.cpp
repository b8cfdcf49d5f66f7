#include "masks/find_masks.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/error.h"
#include "core/option_word.h"
#include "masks/background.h"
#include "masks/mask_evidence.h"

namespace photohull {
namespace {

constexpr double kMostConfidence = 0.99;  // masks that were given have 1

bool is_object_in_part(const Mask& mask) {
  const auto is_foreground = [](std::uint8_t coverage) { return coverage >= 128; };
  const auto& c = mask.coverage;
  return std::any_of(c.begin(), c.end(), is_foreground) &&
         !std::all_of(c.begin(), c.end(), is_foreground);
}

struct Found {
  Mask mask;
  double confidence = 0;
};

/// The mask that the evidence gives. The cut is tried in any case: where it moves the contour the
/// evidence did not say where it is.
Found decide(const MaskEvidence& evidence, const ColourImage& image, bool cut) {
  Found out{mask_from_evidence(evidence), 0};
  if (!is_object_in_part(out.mask)) return {};
  Mask moved = cut_band(evidence, image, out.mask);
  out.confidence = mask_confidence(evidence, out.mask, &moved);
  if (cut && is_object_in_part(moved)) out.mask = std::move(moved);
  return out;
}

ColourImage load_plate(const SourceView& source, const ColourImage& image,
                       const ViewLoader& loader) {
  ColourImage plate = loader.image(source.plate);
  if (plate.width != image.width || plate.height != image.height)
    throw Error(concat(source.plate.string(), ": the background has ", plate.width, "x",
                       plate.height, " pixels but ", source.name, " has ", image.width, "x",
                       image.height, "; it must be taken with the same camera and settings"));
  return plate;
}

void warn_of_doubtful(const PreparedViews& prepared, const std::vector<MaskOrigin>& origins,
                      std::vector<std::string>& warnings) {
  std::string names;
  int count = 0;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    if (origins[i] != MaskOrigin::kPlate && origins[i] != MaskOrigin::kBackground) continue;
    if (prepared.masks[i].confidence >= MaskJudgement::kDoubtful) continue;
    if (++count <= 5) names += (names.empty() ? "" : ", ") + prepared.views[i].name;
  }
  if (count > 0)
    warnings.push_back(concat("the masks of ", count, " views are doubtful (", names,
                              count > 5 ? ", ..." : "",
                              "): look at them with 'photohull masks', give a ",
                              option_word("background"), " or masks of your own"));
}

}  // namespace

void find_masks(const Scene& scene, const ViewLoader& loader, bool cut,
                std::vector<MaskOrigin>& origins, PreparedViews& prepared) {
  std::vector<std::size_t> missing, plated;
  std::vector<const ColourImage*> images;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    if (origins[i] != MaskOrigin::kNone || !scene.views[i].silhouette) continue;
    if (!scene.views[i].plate.empty()) {
      plated.push_back(i);
    } else {
      missing.push_back(i);
      images.push_back(&prepared.views[i].image);
    }
  }
  std::vector<Found> found(origins.size());
  tbb::parallel_for(std::size_t(0), plated.size(), [&](std::size_t k) {
    const std::size_t i = plated[k];
    const ColourImage& image = prepared.views[i].image;
    const ColourImage plate = load_plate(scene.views[i], image, loader);
    found[i] = decide(compare_with_plate(image, plate), image, cut);
  });
  if (!missing.empty()) {
    const BackgroundModel model = estimate_background(images);
    if (!model.usable())
      prepared.warnings.push_back(
          concat(missing.size(),
                 " views have no mask, and their background does not stand out "
                 "enough to find one; carving must do without"));
    else
      tbb::parallel_for(std::size_t(0), missing.size(), [&](std::size_t k) {
        const ColourImage& image = prepared.views[missing[k]].image;
        found[missing[k]] = decide(compare_with_model(model, image), image, cut);
      });
    const auto good = std::size_t(std::count_if(
        missing.begin(), missing.end(), [&](std::size_t i) { return !found[i].mask.empty(); }));
    if (model.usable() && 2 * good <= missing.size()) {
      prepared.warnings.push_back(concat("the background model finds the object in ", good, " of ",
                                         missing.size(), " views only; its masks are not used"));
      missing.clear();
    }
    if (!model.usable()) missing.clear();
  }
  const auto take = [&](std::size_t i, MaskOrigin origin, const char* what) {
    if (found[i].mask.empty()) {
      prepared.warnings.push_back(concat(prepared.views[i].name, ": the background ", what,
                                         " finds no mask; the view is used without"));
      return;
    }
    prepared.views[i].mask = std::move(found[i].mask);
    prepared.masks[i].confidence = std::min(found[i].confidence, kMostConfidence);
    origins[i] = origin;
  };
  for (const std::size_t i : plated) take(i, MaskOrigin::kPlate, "plate");
  for (const std::size_t i : missing) take(i, MaskOrigin::kBackground, "model");
  warn_of_doubtful(prepared, origins, prepared.warnings);
}

}  // namespace photohull

#include "masks/masks.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <map>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/option_word.h"
#include "core/scaled_size.h"
#include "masks/mask_lines.h"

namespace photohull {
namespace {

constexpr std::uint16_t kHalfOne = 0x3c00;
constexpr double kWholeFrame = 0.98;        // of the pixels along the frame
constexpr double kSomeBackground = 0.9995;  // of the pixels are foreground, at most
constexpr double kNearlyAll = 0.9;          // of the views

std::size_t pixel_count(const ColourImage& image) {
  return std::size_t(image.width) * image.height;
}

std::uint16_t half_alpha(const ColourImage& image, std::size_t pixel) {
  std::uint16_t alpha;
  std::memcpy(&alpha, &image.bytes[pixel * 8 + 6], sizeof alpha);
  return alpha;
}

/// Coverage from the alpha channel.
Mask mask_from_alpha(const ColourImage& image) {
  Mask mask{image.width, image.height, std::vector<std::uint8_t>(pixel_count(image))};
  for (std::size_t i = 0; i < mask.coverage.size(); ++i)
    mask.coverage[i] =
        image.encoding == ColourImage::Encoding::kSrgb8
            ? image.bytes[i * 4 + 3]
            : std::uint8_t(std::lround(
                  255 * std::clamp(glm::unpackHalf1x16(half_alpha(image, i)), 0.0f, 1.0f)));
  return mask;
}

bool varies(const Mask& mask) {
  const auto [low, high] = std::minmax_element(mask.coverage.begin(), mask.coverage.end());
  return *low != *high;
}

/// Mean coverage over a rectangle, in [0, 1].
double mean_coverage(const Mask& mask, int x0, int y0, int x1, int y1) {
  double sum = 0;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) sum += mask.coverage[std::size_t(y) * mask.width + x];
  return sum / (255.0 * std::max(x1 - x0, 1) * std::max(y1 - y0, 1));
}

/// Mean coverage of the pixels along the frame, in [0, 1].
double frame_coverage(const Mask& mask) {
  const int w = mask.width, h = mask.height;
  const double sum = (mean_coverage(mask, 0, 0, w, 1) + mean_coverage(mask, 0, h - 1, w, h)) * w +
                     (mean_coverage(mask, 0, 0, 1, h) + mean_coverage(mask, w - 1, 0, w, h)) * h;
  return sum / (2 * w + 2 * h);
}

/// Mostly foreground along the frame and mostly background in the middle third?
bool looks_inverted(const Mask& mask) {
  const int w = mask.width, h = mask.height;
  return frame_coverage(mask) > 0.5 &&
         mean_coverage(mask, w / 3, h / 3, w - w / 3, h - h / 3) < 0.5;
}

/// Is there background, and is it all closed in by foreground that runs along the whole frame? Of a
/// thin object that is what an inverted mask looks like. In some views a right one may look so,
/// too, where something is cut out of a scene that fills the frame.
bool closes_background_in(const Mask& mask) {
  return frame_coverage(mask) > kWholeFrame &&
         mean_coverage(mask, 0, 0, mask.width, mask.height) < kSomeBackground;
}

/// A mask of another size over the same picture: coverage is averaged over the pixels' areas where
/// the mask is larger, and interpolated where it is smaller.
Mask resized(Mask& mask, int width, int height) {
  Mask out{width, height, std::vector<std::uint8_t>(std::size_t(width) * height)};
  const cv::Mat from(mask.height, mask.width, CV_8U, mask.coverage.data());
  cv::Mat to(height, width, CV_8U, out.coverage.data());
  cv::resize(from, to, to.size(), 0, 0,
             mask.width > width ? cv::INTER_AREA : cv::INTER_LINEAR_EXACT);
  return out;
}

const char* to_string(MaskOrigin origin) {
  switch (origin) {
    case MaskOrigin::kFile:
      return "mask files";
    case MaskOrigin::kAlpha:
      return "alpha channels";
    case MaskOrigin::kPlate:
      return "background plate";
    case MaskOrigin::kBackground:
      return "background model";
    case MaskOrigin::kNone:
      break;
  }
  return "none";
}

}  // namespace

void make_opaque(ColourImage& image) {
  if (!image.has_alpha) return;
  for (std::size_t i = 0; i < pixel_count(image); ++i) {
    if (image.encoding == ColourImage::Encoding::kSrgb8)
      image.bytes[i * 4 + 3] = 255;
    else
      std::memcpy(&image.bytes[i * 8 + 6], &kHalfOne, sizeof kHalfOne);
  }
  image.has_alpha = false;
}

MaskOrigin take_given_mask(const SourceView& source, const ViewLoader& loader, PreparedView& view,
                           bool& from_ones) {
  MaskOrigin origin = MaskOrigin::kNone;
  if (!source.mask.empty()) {
    FileMask mask = loader.mask(source.mask);
    from_ones = mask.from_ones;
    view.mask = std::move(mask);
    if (is_scaled_copy(view.mask.width, view.mask.height, view.image.width, view.image.height))
      view.mask = resized(view.mask, view.image.width, view.image.height);
    if (view.mask.width != view.image.width || view.mask.height != view.image.height)
      throw Error(concat(source.mask.string(), ": the mask has ", view.mask.width, "x",
                         view.mask.height, " pixels but its picture has ", view.image.width, "x",
                         view.image.height, "; masks must match pixel by pixel"));
    origin = MaskOrigin::kFile;
  } else if (view.image.has_alpha) {
    Mask mask = mask_from_alpha(view.image);
    if (varies(mask)) {
      view.mask = std::move(mask);
      origin = MaskOrigin::kAlpha;
    }
  }
  return origin;
}

void describe_masks(const std::vector<MaskOrigin>& origins, PreparedViews& views) {
  double least = 1;
  bool any = false;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    MaskJudgement& judged = views.masks[i];
    judged.source = to_string(origins[i]);
    if (origins[i] == MaskOrigin::kNone) continue;
    if (origins[i] == MaskOrigin::kFile || origins[i] == MaskOrigin::kAlpha) judged.confidence = 1;
    least = std::min(least, judged.confidence);
    any = true;
  }
  views.mask_confidence = any ? least : 0;
  std::map<MaskOrigin, int> counts;
  for (const MaskOrigin origin : origins) ++counts[origin];
  views.mask_source.clear();
  for (const auto& [origin, count] : counts) {
    if (!views.mask_source.empty()) views.mask_source += ", ";
    views.mask_source += to_string(origin);
    if (counts.size() > 1) views.mask_source += concat(" (", count, " views)");
  }
}

void check_masks(PreparedViews& views) {
  std::size_t masks = 0, empty = 0, inverted = 0, closed_in = 0;
  for (const PreparedView& view : views.views) {
    if (view.mask.empty()) continue;
    ++masks;
    const auto is_foreground = [](std::uint8_t coverage) { return coverage >= 128; };
    const auto& coverage = view.mask.coverage;
    // An object may be thinner than a pixel everywhere.
    if (std::none_of(coverage.begin(), coverage.end(), is_foreground) &&
        find_lines(view.mask).empty()) {
      ++empty;
      views.warnings.push_back(concat(view.name, ": the mask is empty: the view shows no object"));
    } else if (std::all_of(coverage.begin(), coverage.end(), is_foreground)) {
      views.warnings.push_back(concat(view.name, ": the mask is all foreground"));
    }
    inverted += looks_inverted(view.mask);
    closed_in += looks_inverted(view.mask) || closes_background_in(view.mask);
  }
  if (masks > 0 && empty == masks)
    throw Error("all masks are empty: white must be the object, black the background");
  if (2 * inverted > masks)
    throw Error(concat("masks look inverted: in ", inverted, " of ", masks,
                       " the frame is foreground and the middle background; "
                       "white must be the object"));
  if (double(closed_in) > kNearlyAll * double(masks))
    throw Error(concat("masks look inverted: in ", closed_in, " of ", masks,
                       " foreground runs along the whole frame and closes the background in; white "
                       "must be the object (",
                       option_word("masks", "none"), " goes without them)"));
}

}  // namespace photohull

#include "pose/pose_scenery.h"

#include <algorithm>
#include <cmath>

#include "calib/sheet_hull.h"
#include "calib/sheet_look.h"
#include "core/image_scale.h"
#include "core/scaled_size.h"
#include "io/image_file.h"
#include "masks/find_sheet_light.h"
#include "masks/sheet_mask.h"
#include "photo/for_photographs.h"

namespace photohull::pose {
namespace {

constexpr double kTexelsPerMm = 4;
constexpr double kSmall = 4e5;  // pixels of the pictures whose masks tell where the object can be
constexpr double kLarge = 2e6;  // of those by which light is told in the end
constexpr double kFine = 0.3, kCoarse = 0.6;  // mm between the lattice points of light, at either
constexpr int kRounds = 2;
constexpr std::uint8_t kMaybe = 32;  // coverage from which a mask does not take from the others

/// A mask's value where a picture of `width` x `height` pixels has one.
std::uint8_t value_at(const Mask& mask, int x, int y, int width, int height) {
  const auto u = std::size_t(x) * std::size_t(mask.width) / std::size_t(width);
  const auto v = std::size_t(y) * std::size_t(mask.height) / std::size_t(height);
  return mask.coverage[v * std::size_t(mask.width) + u];
}

/// Of a photograph that tells nothing yet: others say where its object is.
Mask anywhere(int width, int height) {
  return {width, height, std::vector<std::uint8_t>(std::size_t(width) * std::size_t(height), 255)};
}

/// Is enough of the page seen where the object cannot be?
bool sees_bare_page(const SheetLook& look) {
  constexpr double kEnough = 0.005;  // of the picture
  std::size_t bare = 0;
  for (std::size_t i = 0; i < look.light.size(); ++i)
    bare += look.light[i] >= 0 && look.possible[i] == 0;
  return double(bare) > kEnough * double(look.light.size());
}

/// Where something may lie on the sheet, the object is only where all photographs have room for it,
/// and elsewhere no photographs agree on the light.
void leave_out_covers(const Mask& covered, SheetLook& look) {
  std::size_t i = 0;
  for (int y = 0; y < look.height; ++y)
    for (int x = 0; x < look.width; ++x, ++i)
      if (look.hull[i] == 0 && value_at(covered, x, y, look.width, look.height))
        look.agreed[i] = look.possible[i] = 0;
}

class Exploration {
 public:
  Exploration(const std::vector<std::filesystem::path>& images,
              const std::vector<PosePhoto>& photos, const Sheet& sheet, const PoseResult& result,
              Progress& progress)
      : images_(images),
        photos_(photos),
        sheet_(sheet),
        result_(result),
        progress_(progress),
        picture_(sheet_picture(sheet, kTexelsPerMm)) {
    for (std::size_t i = 0; i < images.size(); ++i)
      if (result.photos[i].posed) posed_.push_back(i);
  }

  SheetScenery run() {
    out_.shadows.resize(images_.size());
    out_.covered.resize(images_.size());
    for_photographs(posed_.size(), kSmall,
                    [&](std::size_t k) { out_.covered[posed_[k]] = covered(posed_[k]); });
    for (int round = 0; round < kRounds; ++round) {
      find_light(scale_to(kSmall), kCoarse);
      out_.shadows = shadows_of_hull(result_, small_masks(scale_to(kSmall)));
    }
    find_light(scale_to(kLarge), kFine);
    return std::move(out_);
  }

 private:
  double scale_to(double pixels) const {
    double scale = 1;
    for (const PosedCamera& c : result_.cameras)
      scale =
          std::min(scale, std::sqrt(pixels / (double(c.intrinsics.width) * c.intrinsics.height)));
    return scale;
  }

  PoseResult scaled(std::size_t photo, int width, int height) const {
    PoseResult out = result_;
    Intrinsics& k = out.cameras[std::size_t(result_.photos[photo].camera)].intrinsics;
    k = scaled_to(k, width, height);
    return out;
  }

  void step(std::size_t done) {
    constexpr double kSteps = 2 * kRounds + 1;
    progress_.update((steps_ + double(done) / double(posed_.size())) / kSteps);
  }

  void find_light(double scale, double finest) {
    std::vector<SheetSight> sights;
    for (const std::size_t i : posed_) {
      const Intrinsics& k = result_.cameras[std::size_t(result_.photos[i].camera)].intrinsics;
      sights.push_back(sight_of_sheet(
          scaled(i, scaled_length(k.width, scale), scaled_length(k.height, scale)), i, sheet_));
    }
    SheetPhotographs photos;
    photos.count = posed_.size();
    photos.image = [&](std::size_t k) {
      progress_.check_cancelled();
      return io::read_image(images_[posed_[k]], scale);
    };
    photos.read = [&](std::size_t count) { step(count); };
    photos.pixel = [&](std::size_t k, const glm::dvec2& place) { return sights[k].pixel(place); };
    photos.possible = [&](std::size_t k, const glm::dvec2& place, const glm::dvec2& pixel,
                          const glm::ivec2& size) {
      const Mask& shadow = out_.shadows[posed_[k]];
      if (!shadow.empty() &&
          !value_at(shadow, int(std::lround(pixel.x)), int(std::lround(pixel.y)), size.x, size.y))
        return false;
      return sights[k].possible(place) || is_covered(posed_[k], place);
    };
    photos.eye = [&](std::size_t k) { return sights[k].eye; };
    photos.print = [&](const glm::dvec2& place) { return picture_.at(place); };
    photos.finest = finest;
    photos.lower_left = sheet_.lower_left, photos.page = sheet_.page;
    out_.light = find_sheet_light(photos);
    ++steps_;
  }

  /// Where a photograph may show what covers tags; empty where it shows all of them. The picture of
  /// a sheet whose light is known near such tags alone tells.
  Mask covered(std::size_t photo) const {
    constexpr double kTexels = 0.5;  // a millimetre
    if (photos_[photo].view.tags.size() >= sheet_.tags.size()) return {};
    SheetLight near;
    near.texels_per_mm = kTexels, near.lower_left = sheet_.lower_left;
    near.width = int(std::ceil(kTexels * sheet_.page.x));
    near.height = int(std::ceil(kTexels * sheet_.page.y));
    near.paper.assign(std::size_t(near.width) * std::size_t(near.height), glm::vec3(1));
    for (int y = 0; y < near.height; ++y)
      for (int x = 0; x < near.width; ++x) {
        const glm::dvec2 place =
            near.lower_left + glm::dvec2(x + 0.5, near.height - y - 0.5) / kTexels;
        near.agreed.push_back(is_covered(photo, place) ? 255 : 0);
      }
    const Intrinsics& k = result_.cameras[std::size_t(result_.photos[photo].camera)].intrinsics;
    const double scale = scale_to(kSmall);
    const int width = scaled_length(k.width, scale), height = scaled_length(k.height, scale);
    SheetLook look = look_at_sheet(scaled(photo, width, height), photo, sheet_, picture_, {}, near);
    return {width, height, std::move(look.agreed)};
  }

  /// Is the place on a tag that the photograph does not show, or near it?
  bool is_covered(std::size_t photo, const glm::dvec2& place) const {
    constexpr double kReach = 0.75;  // of a tag's diagonal, from its middle
    const std::vector<int>& shown = photos_[photo].view.tags;
    return std::ranges::any_of(sheet_.tags, [&](const SheetTag& tag) {
      const double reach = kReach * glm::distance(tag.corners[0], tag.corners[2]);
      const glm::dvec2 middle = 0.5 * (tag.corners[0] + tag.corners[2]);
      return glm::distance(middle, place) < reach &&
             std::ranges::find(shown, tag.id) == shown.end();
    });
  }

  std::vector<Mask> small_masks(double scale) {
    std::vector<Mask> masks(images_.size());
    const auto find_mask = [&](std::size_t k) {
      const std::size_t i = posed_[k];
      progress_.check_cancelled();
      const ColourImage image = io::read_image(images_[i], scale);
      SheetLook look = look_at_sheet(scaled(i, image.width, image.height), i, sheet_, picture_,
                                     blur_of_edges(photos_[i].view.edges, scale), out_.light);
      out_.narrow(i, look);
      masks[i] = mask_from_sheet(image, look).mask;
      for (std::uint8_t& c : masks[i].coverage) c = c >= kMaybe ? 255 : 0;
      if (masks[i].empty()) masks[i] = anywhere(image.width, image.height);
    };
    for_photographs(posed_.size(), kSmall, find_mask, [&](std::size_t done) { step(done); });
    ++steps_;
    return masks;
  }

  const std::vector<std::filesystem::path>& images_;
  const std::vector<PosePhoto>& photos_;
  const Sheet& sheet_;
  const PoseResult& result_;
  Progress& progress_;
  SheetPicture picture_;
  std::vector<std::size_t> posed_;
  SheetScenery out_;
  double steps_ = 0;
};

}  // namespace

void keep_to(const Mask& shadow, int width, int height, std::vector<std::uint8_t>& values) {
  if (shadow.empty()) return;
  std::size_t i = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x, ++i)
      if (!value_at(shadow, x, y, width, height)) values[i] = 0;
}

void note_hull(const Mask& shadow, SheetLook& look) {
  if (shadow.empty()) return;
  look.hull.assign(look.possible.size(), 255);
  keep_to(shadow, look.width, look.height, look.hull);
}

void SheetScenery::narrow(std::size_t photo, SheetLook& look) const {
  if (shadows.empty() || shadows[photo].empty()) return;
  note_hull(shadows[photo], look);
  const bool beside_page = sees_bare_page(look);
  for (std::size_t i = 0; i < look.possible.size(); ++i)
    if (!(beside_page && look.light[i] >= 0) && look.hull[i] == 0) look.possible[i] = 0;
  if (!look.agreed.empty() && !covered.empty() && !covered[photo].empty())
    leave_out_covers(covered[photo], look);
}

SheetScenery explore_sheet(const std::vector<std::filesystem::path>& images,
                           const std::vector<PosePhoto>& photos, const Sheet& sheet,
                           const PoseResult& result, Progress& progress) {
  return Exploration(images, photos, sheet, result, progress).run();
}

}  // namespace photohull::pose

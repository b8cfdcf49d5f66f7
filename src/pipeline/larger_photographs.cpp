#include "pipeline/larger_photographs.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/image_scale.h"
#include "core/scratch_file.h"
#include "masks/masks.h"
#include "photo/noise.h"
#include "pipeline/place_lattice.h"
#include "projtex/gpu_views.h"
#include "projtex/photograph_cache.h"
#include "projtex/photographs.h"
#include "views/crop.h"
#include "views/photometric_samples.h"
#include "views/prepare_views.h"
#include "views/undistort.h"

namespace photohull::pipeline {
namespace {

using Encoding = ColourImage::Encoding;

constexpr std::size_t kDecodedAtOnce = 2;  // photographs, in parallel
constexpr double kDecodedBytes = 8;        // a pixel: as it comes, and with alpha
constexpr double kPixelBytes = 4;          // of 8-bit photographs
constexpr std::size_t kNoisy = 5;          // photographs that tell the noise
constexpr double kMipChain = 4.0 / 3;
constexpr int kFewest = 8;            // held photographs: surfels are matched in six
constexpr double kFreeDisk = 2;       // times what is kept there: results need room, too
constexpr double kMostBytes = 1.9e9;  // of a texture: Mesa's software device takes 2 GiB

/// The intrinsics of `k`, which are of a photograph read at `from` of its size, at `to` of it.
Intrinsics at_scale(Intrinsics k, double from, double to) {
  const double ratio = to / from;
  const glm::dvec2 principal = scaled_pixel({k.cx, k.cy}, ratio);
  k.width = int(std::lround(k.width * ratio));
  k.height = int(std::lround(k.height * ratio));
  k.fx *= ratio, k.fy *= ratio, k.skew *= ratio;
  k.cx = principal.x, k.cy = principal.y;
  return k;
}

/// Bytes, of those that 8-bit photographs take.
int depth_of(Encoding encoding) { return encoding == Encoding::kLinearHalf ? 2 : 1; }

double pixels_of(const glm::ivec2& size) { return double(size.x) * size.y; }

/// Pixels of the largest of the photographs, as they are decoded.
double largest_file(std::span<const PreparedView> views) {
  double most = 0;
  for (const PreparedView& view : views) {
    const Intrinsics k = at_scale(view.source.camera.intrinsics, view.scale, view.matched_scale);
    most = std::max(most, double(k.width) * k.height);
  }
  return most;
}

/// That of the set: what is of higher precision makes all of it so.
Encoding encoding_of(std::span<const PreparedView> views) {
  const bool half = std::ranges::any_of(
      views, [](const PreparedView& v) { return v.image.encoding == Encoding::kLinearHalf; });
  return half ? Encoding::kLinearHalf : Encoding::kSrgb8;
}

/// The folder where it has room for so many bytes, and as many again; else none.
std::filesystem::path with_room(const std::filesystem::path& folder, double bytes) {
  if (folder.empty()) return {};
  std::error_code failure;
  const std::filesystem::space_info space = std::filesystem::space(folder, failure);
  return !failure && double(space.available) >= kFreeDisk * bytes ? folder
                                                                  : std::filesystem::path();
}

/// One photograph, and what is done to it.
struct Entry {
  SourceView source;  ///< at the scale that it is read at
  Camera camera;      ///< of the result
  double scale = 1, sharpness = 1;
  PhotometricCalibration gains;     ///< of it alone; of no views where there are none
  std::optional<ColourImage> kept;  ///< on the disk: what it is, without pixels
};

class LargerPhotographs : public projtex::OutOfCorePhotographs {
 public:
  LargerPhotographs(const PhotographReader& reader, const Subject& subject,
                    const std::optional<PhotometricCalibration>& gains,
                    const ReconstructOptions& options, const Progress& progress)
      : reader_(reader),
        box_(subject.box),
        cut_at_(options.part ? projtex::kCutPixels : 1),
        progress_(progress),
        encoding_(encoding_of(subject.views)) {
    const std::vector<int> lenses = shared_lenses(frames_of(subject.views));
    for (std::size_t i = 0; i < subject.views.size(); ++i) {
      Entry entry = entry_of(subject.views[i]);
      if (gains) {
        entry.gains.views = {gains->views[i]};
        entry.gains.vignetting = {gains->vignetting[std::size_t(lenses[i])]};
      }
      cameras_.push_back(entry.camera);
      entries_.push_back(std::move(entry));
    }
    const double pixels = depth_of(encoding_) * pixels_of(projtex::array_size(cameras_, cut_at_));
    slot_ = std::int64_t(kPixelBytes * pixels);
    scratch_.emplace(with_room(options.checkpoint, double(slot_) * double(entries_.size())));
    const std::int64_t left = subject.held_bytes - held_bytes(0, 0, largest_file(subject.views));
    const double room = std::min(double(left), kMostBytes) / (kMipChain * kPixelBytes * pixels);
    most_ = std::max(kFewest, int(std::min(room, double(entries_.size()))));
    noise_sigma_ = std::max(
        options.noise ? *options.noise / 255 * largest_scale() : measured_noise(), kRoundingNoise);
    // Now, for a device that has no such textures must not tell at the last level.
    cache_.emplace(cameras_, std::min(most_, int(cameras_.size())), encoding_, cut_at_);
  }

  std::span<const Camera> cameras() const override { return cameras_; }
  int most() const override { return most_; }
  double noise_sigma() const override { return noise_sigma_; }

  const projtex::HeldPhotographs& hold(std::span<const int> numbers) override {
    const std::vector<int> missing = cache_->missing(numbers);
    for (std::size_t first = 0; first < missing.size(); first += kDecodedAtOnce) {
      progress_.check_cancelled();
      const auto some =
          std::span(missing).subspan(first, std::min(kDecodedAtOnce, missing.size() - first));
      const std::vector<PreparedView> views = read_all(some);
      for (std::size_t k = 0; k < views.size(); ++k) cache_->put(some[k], views[k]);
    }
    return cache_->held();
  }

 private:
  Entry entry_of(const PreparedView& view) const {
    Entry out;
    out.source = view.source;
    out.scale = view.matched_scale, out.sharpness = view.sharpness;
    Intrinsics& k = out.source.camera.intrinsics;
    k = at_scale(k, view.scale, view.matched_scale);
    // Exactly, where the smaller photograph's last pixels covered less than others.
    const glm::ivec2 size = reader_.size(view.source.image);
    k.width = scaled_length(size.x, out.scale), k.height = scaled_length(size.y, out.scale);
    out.camera = view.camera;
    out.camera.intrinsics =
        pinhole_intrinsics(k, view.source.distortion, PrepareOptions().max_frame_growth);
    out.camera.intrinsics = cropped_intrinsics(box_, kCropMargin, out.camera, cut_at_);
    return out;
  }

  double largest_scale() const {
    double largest = 0;
    for (const Entry& entry : entries_) largest = std::max(largest, entry.scale);
    return largest;
  }

  double measured_noise() {
    const std::size_t count = std::min(kNoisy, entries_.size());
    std::vector<int> numbers;
    for (std::size_t k = 0; k < count; ++k) numbers.push_back(int(k * entries_.size() / count));
    std::vector<double> values;
    for (const PreparedView& view : read_all(numbers))
      values.push_back(estimate_image_noise(view.image));
    std::ranges::nth_element(values, values.begin() + long(values.size() / 2));
    return values[values.size() / 2];
  }

  std::vector<PreparedView> read_all(std::span<const int> numbers) {
    std::vector<PreparedView> out(numbers.size());
    tbb::parallel_for(std::size_t(0), out.size(),
                      [&](std::size_t k) { out[k] = read(std::size_t(numbers[k])); });
    return out;
  }

  /// From the disk as it was when it was read before, or else from its file.
  PreparedView read(std::size_t number) {
    Entry& entry = entries_[number];
    const auto at = std::int64_t(number) * slot_;
    PreparedView view;
    view.name = entry.source.name;
    view.camera = entry.camera;
    view.sharpness = entry.sharpness;
    if (entry.kept) {
      view.image = *entry.kept;
      view.image.bytes.resize(std::size_t(view.image.width) * std::size_t(view.image.height) *
                              view.image.bytes_per_pixel());
      if (scratch_->read(at, view.image.bytes.data(), view.image.bytes.size())) return view;
    }
    view = decode(entry);
    if (scratch_->write(at, view.image.bytes.data(), view.image.bytes.size())) {
      const ColourImage& image = view.image;
      entry.kept = ColourImage{image.width, image.height, image.encoding, image.has_alpha, {}};
    }
    return view;
  }

  PreparedView decode(const Entry& entry) const {
    PreparedView view;
    view.name = entry.source.name;
    view.source = entry.source;
    view.camera = entry.source.camera;
    view.sharpness = entry.sharpness;
    view.image = reader_.image(entry.source.image, entry.scale);
    const Intrinsics& k = view.camera.intrinsics;
    if (view.image.width != k.width || view.image.height != k.height)
      throw Error(concat(entry.source.image.string(), ": the photograph had ", k.width, " x ",
                         k.height, " pixels when the job began, and has ", view.image.width, " x ",
                         view.image.height, " now; start the job anew"));
    make_opaque(view.image);
    undistort(view.source.distortion, PrepareOptions().max_frame_growth, view);
    crop_to_box(box_, kCropMargin, view, cut_at_);
    if (!entry.gains.views.empty()) {
      const std::span one(&view, 1);
      apply_photometric(entry.gains, frames_of(one), {0}, one);
    }
    return view;
  }

  PhotographReader reader_;
  Box box_;
  int cut_at_;
  const Progress& progress_;
  std::vector<Entry> entries_;
  std::vector<Camera> cameras_;
  Encoding encoding_;
  int most_ = 0;
  double noise_sigma_ = 0;
  std::optional<ScratchFile> scratch_;
  std::int64_t slot_ = 0;  // bytes of a photograph there, at most
  std::optional<projtex::PhotographCache> cache_;
};

}  // namespace

std::int64_t held_bytes(int count, double pixels, double decoded) {
  return std::int64_t(kPixelBytes * kMipChain * count * pixels +
                      double(kDecodedAtOnce) * kDecodedBytes * decoded);
}

int fewest_held(std::size_t views) { return int(std::min<std::size_t>(views, kFewest)); }

bool can_be_held(std::size_t views, double pixels) {
  return double(held_bytes(fewest_held(views), pixels, 0)) <= kMostBytes;
}

std::int64_t fewest_held_bytes(std::span<const PreparedView> views) {
  return held_bytes(fewest_held(views.size()),
                    pixels_of(projtex::array_size(matched_cameras(views))), largest_file(views));
}

std::vector<Camera> matched_cameras(std::span<const PreparedView> views) {
  std::vector<Camera> out;
  for (const PreparedView& view : views) {
    out.push_back(view.camera);
    if (view.matched_scale != view.scale)
      out.back().intrinsics = at_scale(view.camera.intrinsics, view.scale, view.matched_scale);
  }
  return out;
}

std::unique_ptr<projtex::OutOfCorePhotographs> larger_photographs(
    const PhotographReader& reader, const Subject& subject,
    const std::optional<PhotometricCalibration>& gains, const ReconstructOptions& options,
    Progress& progress) {
  if (subject.held_bytes == 0) return nullptr;
  const double pixels = depth_of(encoding_of(subject.views)) *
                        pixels_of(projtex::array_size(matched_cameras(subject.views)));
  if (!can_be_held(subject.views.size(), pixels)) {
    progress.warn(concat("the surface is matched in the photographs as they are held: ",
                         fewest_held(subject.views.size()),
                         " larger ones do not fit into one texture"));
    return nullptr;
  }
  auto out = std::make_unique<LargerPhotographs>(reader, subject, gains, options, progress);
  if (const int most = out->most(); most < int(subject.views.size()))
    progress.note(concat("there is room for ", most, " of ", subject.views.size(),
                         " photographs as large as the surface is matched in"));
  return out;
}

}  // namespace photohull::pipeline

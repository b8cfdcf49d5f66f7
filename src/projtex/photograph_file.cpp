#include "projtex/photograph_file.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <functional>
#include <numeric>
#include <span>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/lists.h"
#include "projtex/photograph_cache.h"

namespace photohull::projtex {
namespace {

namespace fs = std::filesystem;
using Encoding = ColourImage::Encoding;

constexpr char kMagic[] = "photohull photographs 1\n";

struct Header {
  int most = 0;  // held at once
  Encoding encoding = Encoding::kSrgb8;
  double noise_sigma = 0;
};

/// The `n`-th photograph, while it is on the device.
struct Layer {
  const ImageSet& images;
  int layer;
};

ColourImage empty_image(const Camera& camera, Encoding encoding) {
  return {camera.intrinsics.width, camera.intrinsics.height, encoding, false, {}};
}

std::size_t bytes_of(const ColourImage& image) {
  return std::size_t(image.width) * std::size_t(image.height) * image.bytes_per_pixel();
}

/// After the header: each photograph's sharpness and pixels.
void write(const fs::path& target, const Header& header, std::span<const Camera> cameras,
           const std::function<Layer(int)>& layer_of) {
  AtomicFile file(target);
  ListWriter writer([&](const void* data, std::size_t size) { file.write(data, size); });
  writer.text(kMagic);
  writer.one(header);
  writer.list(cameras);
  for (int n = 0; n < int(cameras.size()); ++n) {
    const auto [images, layer] = layer_of(n);
    const Intrinsics& k = cameras[std::size_t(n)].intrinsics;
    const ColourImage image = images.read(layer, {k.width, k.height});
    const double sharpness = images.sharpness()[std::size_t(layer)];
    file.write(&sharpness, sizeof sharpness);
    file.write(image.bytes.data(), image.bytes.size());
  }
  file.commit();
}

class PhotographFile : public OutOfCorePhotographs {
 public:
  explicit PhotographFile(const fs::path& path) : path_(path), stream_(path, std::ios::binary) {
    std::error_code failure;
    const std::uint64_t bytes = fs::file_size(path, failure);
    if (failure || !stream_) throw Error(concat(path.string(), ": the file cannot be read"));
    try {
      ListReader reader(
          [&](void* target, std::size_t size) {
            return bool(stream_.read(static_cast<char*>(target), std::streamsize(size)));
          },
          bytes);
      if (reader.text() != kMagic) throw Error("it holds no photographs of this version");
      header_ = reader.one<Header>();
      cameras_ = reader.list<Camera>();
    } catch (const Error& problem) {
      throw Error(concat(path.string(), ": ", problem.what()));
    }
    auto at = std::int64_t(stream_.tellg());
    for (const Camera& camera : cameras_) {
      starts_.push_back(at);
      at += std::int64_t(sizeof(double) + bytes_of(empty_image(camera, header_.encoding)));
    }
    if (cameras_.empty() || header_.most < 1 || std::uint64_t(at) != bytes) throw_short();
    const int layers = std::min(header_.most, int(cameras_.size()));
    cache_.emplace(cameras_, layers, header_.encoding);
    if (layers < int(cameras_.size())) return;
    std::vector<int> all(cameras_.size());
    std::iota(all.begin(), all.end(), 0);
    hold(all);
  }

  std::span<const Camera> cameras() const override { return cameras_; }
  double noise_sigma() const override { return header_.noise_sigma; }
  int most() const override { return header_.most; }

  const HeldPhotographs& hold(std::span<const int> numbers) override {
    for (const int n : cache_->missing(numbers)) {
      double sharpness = 0;
      ColourImage image = empty_image(cameras_[std::size_t(n)], header_.encoding);
      image.bytes.resize(bytes_of(image));
      stream_.seekg(starts_[std::size_t(n)]);
      stream_.read(reinterpret_cast<char*>(&sharpness), sizeof sharpness);
      if (!stream_.read(reinterpret_cast<char*>(image.bytes.data()),
                        std::streamsize(image.bytes.size())))
        throw_short();
      cache_->put(n, image, sharpness);
    }
    return cache_->held();
  }

 private:
  [[noreturn]] void throw_short() const {
    throw Error(concat(path_.string(), ": the photographs end too early"));
  }

  fs::path path_;
  std::ifstream stream_;
  Header header_;
  std::vector<Camera> cameras_;
  std::vector<std::int64_t> starts_;  // of each photograph, in the file
  std::optional<PhotographCache> cache_;
};

}  // namespace

void write_photographs(const fs::path& file, const Photographs& all) {
  write(file, {int(all.cameras.size()), all.images.encoding(), all.noise_sigma}, all.cameras,
        [&](int n) {
          return Layer{all.images, n};
        });
}

void write_photographs(const fs::path& file, OutOfCorePhotographs& some) {
  const HeldPhotographs& first = some.hold(std::array{0});
  write(file, {some.most(), first.images.encoding(), some.noise_sigma()}, some.cameras(),
        [&](int n) {
          const HeldPhotographs& held = some.hold(std::array{n});
          return Layer{held.images, held.layers[std::size_t(n)]};
        });
}

std::unique_ptr<OutOfCorePhotographs> open_photographs(const fs::path& file) {
  return std::make_unique<PhotographFile>(file);
}

}  // namespace photohull::projtex

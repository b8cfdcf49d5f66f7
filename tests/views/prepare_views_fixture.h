// A scene of pictures from memory, for prepare_views.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>

#include "core/error.h"
#include "support/pictures.h"
#include "views/prepare_views.h"

namespace photohull {

constexpr int kWidth = 64, kHeight = 48;

inline double disc(double x, double y) {
  return std::clamp(14.5 - std::hypot(x - 30, y - 24), 0.0, 1.0);
}

inline ColourImage clay_disc() {
  return paint_srgb(kWidth, kHeight, [](double x, double y) {
    return float(disc(x, y)) * glm::vec3(0.5f, 0.4f + 0.002f * float(x), 0.3f);
  });
}

/// A scene whose files live in memory.
class PrepareViews : public testing::Test {
 protected:
  void add_view(const std::string& name, const ColourImage& image) {
    SourceView view;
    view.name = name;
    view.image = "images/" + name;
    view.camera.intrinsics = {image.width, image.height, 60, 60, 0, 31.5, 23.5};
    scene_.views.push_back(view);
    images_["images/" + name] = image;
  }

  void add_mask(const Mask& mask) {
    SourceView& view = scene_.views.back();
    view.mask = "masks/" + view.name;
    masks_[view.mask.string()] = mask;
  }

  PreparedViews prepare(const PrepareOptions& options = {}) {
    ViewLoader loader;
    loader.image = [this](const std::filesystem::path& p) {
      ++loads_;
      return images_.at(p.string());
    };
    loader.mask = [this](const std::filesystem::path& p) { return masks_.at(p.string()); };
    return prepare_views(scene_, loader, options, progress_);
  }

  std::string error_of_prepare() {
    try {
      prepare();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  Scene scene_;
  std::map<std::string, ColourImage> images_;
  std::map<std::string, Mask> masks_;
  std::atomic<int> loads_{0};
  Progress progress_;
};

inline const Mask kDisc = paint_mask(kWidth, kHeight, disc);

}  // namespace photohull

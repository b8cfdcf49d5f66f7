// A surface of the bowl, refined in all the ways that tests ask for.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "bowl_scene.h"
#include "core/error.h"
#include "projtex/out_of_core.h"
#include "refine/refine.h"
#include "refine/view_choice.h"
#include "support/gl_context.h"

namespace photohull::refine {

/// Refines the bowl.
class RefineSurface : public testing::Test {
 protected:
  RefineSurface() {
    options_.levels = 2;
    options_.noise_sigma = 0.01;
  }

  SparseVolume run(int edge, bool masks = true) {
    gpu::Context& context = test::gl_context();
    const auto hull_at = [&](const GridSpec& grid) { return scene_.hull(grid, masks); };
    return refine_surface(
        context,
        {scene_.grid(edge), hull_at, scene_.silhouettes(masks), projtex::ImageSet(scene_.views),
         scene_.cameras, larger_, before_, shared_},
        options_, progress_, &report_);
  }

  const test::BowlScene& scene_ = test::bowl_scene();
  RefineOptions options_;
  Progress progress_;
  RefineReport report_;
  projtex::OutOfCorePhotographs* larger_ = nullptr;
  const MomentBefore* before_ = nullptr;
  SharedWork* shared_ = nullptr;
};

/// The scene's photographs, of which it holds a few.
class FewPhotographs : public projtex::OutOfCorePhotographs {
 public:
  FewPhotographs(const test::BowlScene& scene, int most, double noise_sigma)
      : scene_(scene), most_(most), noise_sigma_(noise_sigma) {}

  std::span<const Camera> cameras() const override { return scene_.cameras; }
  int most() const override { return most_; }
  double noise_sigma() const override { return noise_sigma_; }
  const projtex::HeldPhotographs& hold(std::span<const int> numbers) override {
    EXPECT_LE(int(numbers.size()), most_);
    ++times_;
    std::vector<PreparedView> views;
    std::vector<Camera> cameras;
    std::vector<int> layers(scene_.views.size(), -1);
    for (const int n : numbers) {
      layers[std::size_t(n)] = int(views.size());
      views.push_back(scene_.views[std::size_t(n)]);
      cameras.push_back(scene_.cameras[std::size_t(n)]);
    }
    held_ =
        projtex::HeldPhotographs{projtex::ImageSet(views), std::move(cameras), std::move(layers)};
    return *held_;
  }
  int times() const { return times_; }

 private:
  const test::BowlScene& scene_;
  int most_;
  double noise_sigma_;
  int times_ = 0;
  std::optional<projtex::HeldPhotographs> held_;
};

}  // namespace photohull::refine

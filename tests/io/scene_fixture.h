// Small scenes in a temporary folder, for the tests of io.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/scene.h"

namespace photohull::io {

/// Each test gets an empty folder, removed after it.
class TemporaryFolder : public testing::Test {
 protected:
  TemporaryFolder();
  ~TemporaryFolder() override;

  /// Writes a text file below the folder; parent folders are made.
  std::filesystem::path put(const std::string& name, const std::string& text) const;
  /// Writes a small PNG of uniform grey below the folder.
  std::filesystem::path put_image(const std::string& name, int width = 8, int height = 6,
                                  int value = 100) const;

  std::filesystem::path folder_;
};

/// The message of the Error (or UsageError) that a call throws; a test failure when it throws
/// nothing or something else.
std::string error_of(const std::function<void()>& call);

/// Three cameras in general position on images 8 x 6, principal points off centre, unlike focal
/// lengths; images at `images`/a.png, b.png, c.png exist.
Scene example_scene(const std::filesystem::path& images);

/// Largest distance in pixels between where the two scenes' cameras see a few world points, once
/// views are matched by name.
double largest_shift(const Scene& a, const Scene& b);

}  // namespace photohull::io

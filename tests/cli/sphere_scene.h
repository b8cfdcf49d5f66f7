// A scene whose answer is known: photographs of a textured sphere, in a folder of the test's own.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "child_process.h"
#include "core/scene.h"

namespace photohull::test {

/// The sphere and the region around it.
inline const glm::dvec3 kCentre(0.1, -0.2, 0.3);
inline constexpr double kRadius = 0.8;
inline constexpr double kSphereVolume = 2.1446605848506324;  // 4/3 pi 0.8^3
inline constexpr int kWidth = 96, kHeight = 72, kViews = 16;

/// Every test gets `folder_`, removed after it, with photographs in images/, masks in cutouts/ and
/// a Middlebury scene with its box. scene_ is that scene, for the writers of other formats.
class SphereScene : public testing::Test {
 protected:
  SphereScene();
  ~SphereScene() override;

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string image(int view) const { return path("images/" + scene_.views[view].name); }
  std::string mask_file(int view) const { return path("cutouts/" + scene_.views[view].name); }
  /// The scene and where the results go.
  std::string scene() const { return folder_.string(); }
  std::string out() const { return path("out"); }

  /// Arguments of a quick reconstruction from masks, and further ones.
  Arguments reconstruct(const Arguments& more = {}) const;
  /// Runs these arguments and expects exit code 0.
  Finished succeed(const Arguments& arguments, const RunOptions& options = {}) const;
  /// Runs these arguments and expects the code, a single sentence with all of `parts` as the last
  /// line, nothing on standard output and nothing new in the output folder.
  Finished fail(int code, const Arguments& arguments, const std::vector<std::string>& parts,
                const RunOptions& options = {}) const;

  void write_scene_file() const;  ///< scene_ as scene_par.txt and bbox.txt
  void write_masks(const std::string& name, int object, int background) const;

  std::filesystem::path folder_;
  Scene scene_;
};

/// Names of the files and folders below a folder, sorted; nothing when it does not exist.
std::vector<std::string> listing(const std::filesystem::path& folder);
std::string read_bytes(const std::filesystem::path& file);
void write_bytes(const std::filesystem::path& file, const std::string& bytes);
/// Replaces the first `from` in a file, which must be there.
void edit(const std::filesystem::path& file, const std::string& from, const std::string& to);

}  // namespace photohull::test

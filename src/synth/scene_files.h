// The folder of a synthesized scene. Internal to synth.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "synth/degrade_mask.h"
#include "synth/truth.h"

namespace photohull::synth {

/// The folder that a scene is written to. Files appear whole, each by itself; spec.json is the
/// last, and until then a file INCOMPLETE marks the folder as ours.
class SceneFiles {
 public:
  /// Makes the folder, or clears an older scene's own pictures out of it. Throws Error when the
  /// folder holds anything but a synthesized scene, or cannot be written.
  SceneFiles(const std::filesystem::path& folder, const std::vector<std::string>& views,
             const ImageSpec& image);

  void write_picture(const std::string& view, int width, int height,
                     const std::vector<std::uint8_t>& rgb) const;
  /// 16 bits a channel.
  void write_picture(const std::string& view, int width, int height,
                     const std::vector<std::uint16_t>& rgb) const;
  /// depth/ and normals/.
  void write_maps(const std::string& view, const Picture& picture) const;
  void write_plate(const std::string& view, int width, int height,
                   const std::vector<std::uint8_t>& rgb) const;
  void write_mask(const std::string& view, const Mask& mask) const;
  void write_truth(const TriMesh& mesh, const std::vector<TruthSample>& samples) const;
  /// Every format that can express the cameras, and bbox.txt; `exact` also to true_cameras/ where
  /// it differs.
  void write_cameras(const std::vector<std::string>& views, const std::vector<LensCamera>& written,
                     const std::vector<LensCamera>& exact, bool differ, const Box& box) const;
  /// Writes spec.json and takes the mark away.
  void finish(const std::string& spec_json) const;

 private:
  std::filesystem::path folder_;
  bool masks_ = true;
};

/// An OpenEXR file of 32-bit floats: 1 channel "Z" or 3 channels "R", "G", "B".
void write_exr(const std::filesystem::path& path, int width, int height, int channels,
               const float* pixels);

}  // namespace photohull::synth

// A process that helps others with their reconstructions.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace photohull::pipeline {

/// Has the job whose ReconstructOptions::tiles name the folder tiles that nobody has done yet?
bool can_be_helped(const std::filesystem::path& folder);

/// Helps with one job, on a device of its own: a thread has one at a time.
class Helper {
 public:
  /// Throws Error where there is no such device.
  Helper(const std::filesystem::path& folder, const std::string& device, int threads);
  ~Helper();

  /// Does a tile that nobody is at. False: there is none. Throws as refine::TileHelper does.
  bool help();

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace photohull::pipeline

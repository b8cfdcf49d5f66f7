// A process that helps others with their reconstructions.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace photohull::pipeline {

/// Helps with one job, whose ReconstructOptions::tiles name the folder.
class Helper {
 public:
  Helper(std::filesystem::path folder, std::string device, int threads);
  ~Helper();

  /// Does a tile that nobody is at. False: there is none. Throws Error where this process cannot
  /// do what the job needs, as refine::TileHelper does and where there is no such device.
  bool help();

 private:
  struct Work;
  std::filesystem::path folder_;
  std::string device_;
  int threads_;
  std::unique_ptr<Work> work_;  // made when there is something to do
};

}  // namespace photohull::pipeline

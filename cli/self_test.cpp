#include "self_test.h"

#include <chrono>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "pipeline/reconstruct.h"

namespace photohull::cli {
namespace {

constexpr int kSize = 96;  // pixels
constexpr int kViews = 12, kResolution = 32;
constexpr double kDistance = 4;        // of the cameras from the ball's middle; its radius is 1
constexpr double kWorstVolume = 0.12;  // by which hulls of so few views and voxels may be off

/// A camera that looks at the origin.
Camera camera_at(const glm::dvec3& place) {
  const glm::dvec3 forward = -glm::normalize(place),
                   right = glm::normalize(glm::cross(forward, glm::dvec3(0, 0, 1))),
                   down = glm::cross(forward, right);
  const double middle = 0.5 * (kSize - 1), focal = 1.6 * kSize;
  Camera camera;
  camera.intrinsics = {kSize, kSize, focal, focal, 0, middle, middle};
  const glm::dmat3 rotation = glm::transpose(glm::dmat3(right, down, forward));
  camera.cam_from_world = {rotation, -(rotation * place)};
  return camera;
}

/// The ball before black, patterned, with its exact silhouette.
pipeline::MemoryPhotograph photograph(int index) {
  const double pi = std::acos(-1.0), angle = 2 * pi * index / kViews, up = index % 2 ? 0.6 : -0.2;
  pipeline::MemoryPhotograph p;
  p.name = concat("view ", index);
  p.camera =
      camera_at(kDistance * glm::normalize(glm::dvec3(std::cos(angle), std::sin(angle), up)));
  p.image = {kSize, kSize, ColourImage::Encoding::kSrgb8, false, {}};
  p.mask = {kSize, kSize, {}};
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const glm::dvec3 from = p.camera.center(), ray = p.camera.ray({x, y});
      const double along = -glm::dot(from, ray);
      const double reach = 1 - glm::dot(from, from) + along * along;
      const glm::dvec3 hit = from + (along - std::sqrt(std::max(reach, 0.0))) * ray;
      const bool ball = reach > 0;
      for (int c = 0; c < 3; ++c)
        p.image.bytes.push_back(
            ball ? std::uint8_t(128 + 90 * std::sin(9 * hit[c]) * std::cos(7 * hit[(c + 1) % 3]))
                 : std::uint8_t(0));
      p.image.bytes.push_back(255);
      p.mask.coverage.push_back(ball ? 255 : 0);
    }
  return p;
}

double carved_volume(const std::string& device) {
  std::vector<pipeline::MemoryPhotograph> photographs;
  for (int i = 0; i < kViews; ++i) photographs.push_back(photograph(i));
  pipeline::ReconstructOptions options;
  options.device = device;
  options.method = pipeline::Method::kHull;
  options.resolution = kResolution;
  options.report_page = pipeline::ReportPage::kOff;
  Progress progress;
  const Box box{glm::dvec3(-1.2), glm::dvec3(1.2)};
  const pipeline::Reconstruction made = pipeline::Reconstructor(options).run(
      pipeline::photographs_in_memory(std::move(photographs), box), progress);
  return double(made.volume.inside_voxels()) * std::pow(made.volume.grid.voxel_size, 3) /
         (4 / 3.0 * std::acos(-1.0));
}

}  // namespace

SelfTest run_self_test(const std::string& device) {
  SelfTest test;
  const auto start = std::chrono::steady_clock::now();
  try {
    test.volume = carved_volume(device);
    if (!(std::abs(test.volume - 1) < kWorstVolume))
      test.fault = concat("the ball that was carved has ", test.volume,
                          " of the true one's volume: this device computes wrongly");
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& failure) {
    test.fault = failure.what();
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  test.seconds = elapsed.count();
  return test;
}

}  // namespace photohull::cli

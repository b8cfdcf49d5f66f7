#include "pipeline/job_identity.h"

#include <xxhash.h>

#include <cstdio>
#include <iomanip>
#include <sstream>

namespace photohull::pipeline {
namespace {

namespace fs = std::filesystem;

/// Size and time of a file's last change; nothing of a file that is not there.
void add_file(const fs::path& path, std::ostream& out) {
  std::error_code error;
  out << std::quoted(path.string());
  if (const auto size = fs::file_size(path, error); !error) out << ' ' << size;
  if (const auto time = fs::last_write_time(path, error); !error)
    out << ' ' << time.time_since_epoch().count();
  out << '\n';
}

void add_camera(const SourceView& view, std::ostream& out) {
  const Intrinsics& k = view.camera.intrinsics;
  out << k.width << ' ' << k.height << ' ' << k.fx << ' ' << k.fy << ' ' << k.skew << ' ' << k.cx
      << ' ' << k.cy;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out << ' ' << view.camera.cam_from_world.rotation[i][j];
  for (int i = 0; i < 3; ++i) out << ' ' << view.camera.cam_from_world.translation[i];
  out << ' ' << int(view.distortion.model);
  for (const double c : view.distortion.coefficients) out << ' ' << c;
  out << '\n';
}

}  // namespace

std::string job_identity(const ReconstructOptions& options, const Scene& scene,
                         const GridSpec& grid, const std::string& device) {
  std::ostringstream text;
  text << std::setprecision(17) << PHOTOHULL_VERSION << '\n'
       << device << '\n'
       << to_string(options.quality) << ' ' << to_string(options.effective_method()) << ' '
       << int(options.load.masks) << ' ' << to_string(options.photometric) << '\n';
  if (options.surroundings != Surroundings::kAuto)
    text << "surroundings " << to_string(options.surroundings) << '\n';
  if (options.keep_mask_holes) text << "mask holes\n";
  if (options.views_may_miss) text << "views may miss " << *options.views_may_miss << '\n';
  if (options.box.exact) text << "box exact\n";
  if (options.keep_views) text << "keep views\n";
  if (options.noise) text << "noise " << *options.noise << '\n';
  if (options.mask_offset) text << "mask offset " << *options.mask_offset << '\n';
  for (const std::string& tuned : options.tune) text << std::quoted(tuned) << '\n';
  text << grid.voxel_size << ' ' << grid.origin.x << ' ' << grid.origin.y << ' ' << grid.origin.z
       << ' ' << grid.bricks.x << ' ' << grid.bricks.y << ' ' << grid.bricks.z << '\n';
  for (const glm::dvec3& corner : {scene.box->min, scene.box->max})
    text << corner.x << ' ' << corner.y << ' ' << corner.z << '\n';
  add_file("/proc/self/exe", text);  // versions change less often than programs
  add_file(scene.path, text);
  for (const SourceView& view : scene.views) {
    add_file(view.image, text);
    add_file(view.mask, text);
    add_file(view.plate, text);
    add_camera(view, text);
  }
  const std::string all = text.str();
  const XXH128_hash_t hash = XXH3_128bits(all.data(), all.size());
  char digits[33];
  std::snprintf(digits, sizeof digits, "%016llx%016llx",
                static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  return digits;
}

}  // namespace photohull::pipeline

#include "pipeline/identity_text.h"

#include <iomanip>

namespace photohull::pipeline {

namespace fs = std::filesystem;

void add_file(const fs::path& path, std::ostream& out) {
  std::error_code error;
  out << std::quoted(path.string());
  if (const auto size = fs::file_size(path, error); !error) out << ' ' << size;
  if (const auto time = fs::last_write_time(path, error); !error)
    out << ' ' << time.time_since_epoch().count();
  out << '\n';
}

void add_program(std::ostream& out) {
  out << PHOTOHULL_VERSION << '\n';
  add_file("/proc/self/exe", out);
}

void add_camera(const Camera& camera, std::ostream& out) {
  const Intrinsics& k = camera.intrinsics;
  out << k.width << ' ' << k.height << ' ' << k.fx << ' ' << k.fy << ' ' << k.skew << ' ' << k.cx
      << ' ' << k.cy;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out << ' ' << camera.cam_from_world.rotation[i][j];
  for (int i = 0; i < 3; ++i) out << ' ' << camera.cam_from_world.translation[i];
  out << '\n';
}

void add_distortion(const Distortion& distortion, std::ostream& out) {
  out << int(distortion.model);
  for (const double c : distortion.coefficients) out << ' ' << c;
  out << '\n';
}

}  // namespace photohull::pipeline

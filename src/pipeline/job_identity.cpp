#include "pipeline/job_identity.h"

#include <iomanip>
#include <sstream>

#include "pipeline/input_hashes.h"
#include "pipeline/tuning.h"

namespace photohull::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr int kDigits = 17;  // that tell any two numbers apart

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

/// All that affect what refinement comes to.
void add_options(ReconstructOptions options, io::LoadSceneOptions load, std::ostream& out) {
  options.method = options.effective_method();
  options.tune = assignments_until(Stage::kSurface, options);
  Described described;
  describe(described, options, load);
  for (const Option& option : described.options())
    if (option.from <= Stage::kSurface)
      out << option.name << ' ' << std::quoted(text_of(option, kDigits)) << '\n';
}

}  // namespace

std::string job_identity(const ReconstructOptions& options, const Photographs& photographs,
                         const Subject& subject, const std::string& device) {
  std::ostringstream text;
  text << std::setprecision(kDigits) << PHOTOHULL_VERSION << '\n' << device << '\n';
  add_options(options, photographs.load, text);
  const GridSpec& grid = subject.grid;
  text << grid.voxel_size << ' ' << grid.origin.x << ' ' << grid.origin.y << ' ' << grid.origin.z
       << ' ' << grid.bricks.x << ' ' << grid.bricks.y << ' ' << grid.bricks.z << '\n';
  for (const glm::dvec3& corner : {subject.box.min, subject.box.max})
    text << corner.x << ' ' << corner.y << ' ' << corner.z << '\n';
  add_file("/proc/self/exe", text);  // versions change less often than programs
  add_file(photographs.scene.path, text);
  text << photographs.digest << '\n';
  for (const PreparedView& view : subject.views) {
    add_file(view.source.image, text);
    add_file(view.source.mask, text);
    add_file(view.source.plate, text);
    add_camera(view.source, text);
  }
  const std::string all = text.str();
  return digest_of({reinterpret_cast<const std::uint8_t*>(all.data()), all.size()});
}

}  // namespace photohull::pipeline

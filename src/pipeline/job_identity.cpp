#include "pipeline/job_identity.h"

#include <iomanip>
#include <sstream>

#include "pipeline/identity_text.h"
#include "pipeline/input_hashes.h"
#include "pipeline/tuning.h"

namespace photohull::pipeline {
namespace {

/// All that affect what refinement comes to.
void add_options(ReconstructOptions options, io::LoadSceneOptions load, std::ostream& out) {
  options.method = options.effective_method();
  options.tune = assignments_until(Stage::kSurface, options);
  Described described;
  describe(described, options, load);
  for (const Option& option : described.options())
    if (option.from <= Stage::kSurface)
      out << option.name << ' ' << std::quoted(text_of(option, kIdentityDigits)) << '\n';
}

/// What earlier results give to this one.
void add_earlier(const ReconstructOptions& options, std::ostream& out) {
  if (!options.follow.empty()) add_file(options.follow / "volume.vdb", out);
  if (!options.rig_folder().empty()) add_file(options.rig_folder() / "report.json", out);
}

}  // namespace

std::string job_identity(const ReconstructOptions& options, const Photographs& photographs,
                         const Subject& subject, const std::string& device) {
  std::ostringstream text;
  text << std::setprecision(kIdentityDigits) << device << '\n';
  add_program(text);
  add_options(options, photographs.load, text);
  const GridSpec& grid = subject.grid;
  text << grid.voxel_size << ' ' << grid.origin.x << ' ' << grid.origin.y << ' ' << grid.origin.z
       << ' ' << grid.bricks.x << ' ' << grid.bricks.y << ' ' << grid.bricks.z << '\n';
  add_box(subject.box, text);
  add_earlier(options, text);
  add_file(photographs.scene.path, text);
  text << photographs.digest << '\n';
  for (const PreparedView& view : subject.views) {
    add_file(view.source.image, text);
    add_file(view.source.mask, text);
    add_file(view.source.plate, text);
    add_camera(view.source.camera, text);
    add_distortion(view.source.distortion, text);
    if (view.matched_scale != view.scale) text << "matched at " << view.matched_scale << '\n';
  }
  const std::string all = text.str();
  return digest_of({reinterpret_cast<const std::uint8_t*>(all.data()), all.size()});
}

}  // namespace photohull::pipeline

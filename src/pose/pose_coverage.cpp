#include "pose/pose_coverage.h"

#include "core/atomic_file.h"
#include "io/image_file.h"

namespace photohull::pose {

pipeline::SkyPlace place_of(const PosedSides& sides, const SourceView& view) {
  return pipeline::find_coverage({&view, 1}, sides.middle, sides.up).places.front();
}

std::vector<std::string> check_sides(const std::filesystem::path& folder, const PosedSides& sides) {
  const pipeline::Coverage coverage = pipeline::find_coverage(sides.views, sides.middle, sides.up);
  const std::filesystem::path file = folder / "coverage.png";
  const RgbImage picture = pipeline::draw_coverage(coverage, sides.left_out);
  io::write_png(file, picture.width, picture.height, 3, picture.rgb);
  return pipeline::check_photographs(sides.looks, coverage, file.string());
}

}  // namespace photohull::pose

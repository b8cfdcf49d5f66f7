#include "pipeline/hull_stage.h"

#include <algorithm>
#include <cmath>

#include "carving/bounding.h"
#include "carving/fit_grid.h"
#include "carving/thin_parts.h"
#include "core/error.h"
#include "pipeline/checks.h"
#include "refine/refine.h"
#include "volume/extract_mesh.h"

namespace photohull::pipeline {
namespace {

constexpr double kBoxSlack = 0.5;              // voxels that the surface may stand out of the box
constexpr std::size_t kFewestThinVoxels = 32;  // a hull of fewer, all of them thin, is none
constexpr int kPhotometricVoxels = 160;  // along the box, of the hull that gains are measured on
constexpr int kBoundingMargin = 2;       // coarse voxels around the box
constexpr int kCheckVoxels = 64;         // and of that on which is seen whether they differ

}  // namespace

SparseVolume HullStage::carve_box(const GridSpec& grid, const Box& inner) {
  const std::vector<carving::Silhouette> silhouettes = in_.silhouettes_of_views();
  carving::HullOptions hull_options;
  hull_options.min_views = in_.any_mask() ? 1 : 2;
  hull_options.views_may_miss = options_.views_may_miss.value_or(0);
  hull_options.full_evidence = in_.full_evidence;
  // Where hardly more views see a point than may leave it out, nothing would be known of it.
  if (hull_options.views_may_miss > 0)
    hull_options.min_views =
        std::min(hull_options.views_may_miss + 2, std::max(int(in_.cameras.size()), 1));
  const double slack = options_.box.exact ? 0 : kBoxSlack * grid.voxel_size;
  const Box box{inner.min - slack, inner.max + slack};
  carving::HullReport counts;
  Progress silent;
  SparseVolume volume = carving::carve_silhouette(context_, grid, box, in_.cameras, silhouettes,
                                                  hull_options, silent, &counts);
  const std::size_t thin =
      carving::keep_thin_parts(volume, box, in_.cameras, silhouettes, hull_options);
  report_.nodes_tested += counts.nodes_tested;
  report_.bricks_evaluated += counts.bricks_evaluated;
  samples_ += counts.samples;
  const bool specks = grid.voxel_size == in_.grid.voxel_size && volume.inside_voxels() == thin &&
                      thin < kFewestThinVoxels;  // coarse grids may hold no more of it
  return specks ? SparseVolume() : volume;
}

SparseVolume HullStage::carve(const GridSpec& grid) {
  SparseVolume volume = carve_box(grid, *in_.scene.box);
  if (volume.inside_voxels() == 0)
    throw Error(
        explain_empty_hull(*in_.scene.box, in_.views, in_.silhouettes_of_views(), grid.voxel_size));
  return volume;
}

SparseVolume HullStage::carve_alone() {
  if (!in_.any_mask() && options_.effective_method() == Method::kHull)
    in_.warn(
        "without masks the hull is the box clipped by the frusta: give masks or use "
        "--method refine");
  return carve(in_.grid);
}

const HullStage::Bounds& HullStage::bounds() {
  if (bounds_) return *bounds_;
  GridSpec grid = in_.grid;
  const auto longest = [](const glm::ivec3& n) { return std::max({n.x, n.y, n.z}); };
  while (longest(grid.voxels()) > refine::RefineOptions::kCoarsestVoxels)
    grid = carving::coarser(grid);
  // Outside the box an object that only fills it ends, and one that the box cuts off goes on.
  const double margin = kBoundingMargin * grid.voxel_size;
  const Box room{in_.scene.box->min - margin, in_.scene.box->max + margin};
  const SparseVolume hull = carve_box(carving::fit_grid(room, grid.voxel_size), room);
  if (hull.inside_voxels() == 0) carve(grid);  // tells why
  bounds_ = Bounds{carving::silhouettes_bound(hull, room, in_.silhouettes_of_views()),
                   carving::share_at_box(hull, room)};
  return *bounds_;
}

bool HullStage::bounded() {
  if (!in_.any_mask()) return false;
  if (bounds().all) return true;
  const auto silhouettes = in_.silhouettes_of_views();
  const auto masked = std::count_if(silhouettes.begin(), silhouettes.end(),
                                    [](const carving::Silhouette& v) { return v.distance; });
  in_.warn(concat(
      "the masks do not bound the object: ",
      2 * std::size_t(masked) < silhouettes.size()
          ? concat("only ", masked, " of ", silhouettes.size(), " views have one")
          : concat("what they show goes on beyond the box on ",
                   std::lround(100 * bounds().share_beyond),
                   " % of its surface; is the box too small (--box auto finds one), or do the "
                   "masks show more than the object, or the cameras not see it from around?"),
      "; what no photograph tells of is left open, as without masks"));
  return false;
}

double HullStage::share_beyond() { return in_.any_mask() ? bounds().share_beyond : 1; }

void HullStage::correct_photometric(Progress& progress) {
  const auto hull_of = [&](int voxels, auto&& work) {
    const double coarse = carving::voxel_size_for(*in_.scene.box, voxels);
    const GridSpec grid = carving::fit_grid(*in_.scene.box, std::max(coarse, in_.grid.voxel_size));
    return work(extract_mesh(carve(grid)), grid.voxel_size);
  };
  const auto alike = [&](const TriMesh& mesh, double voxel_size) {
    return photographs_are_alike(mesh, voxel_size, in_, report_, progress);
  };
  if (options_.photometric == Photometric::kAuto && hull_of(kCheckVoxels, alike)) return;
  hull_of(kPhotometricVoxels, [&](const TriMesh& mesh, double voxel_size) {
    return pipeline::correct_photometric(options_.photometric, mesh, voxel_size, in_, report_,
                                         progress);
  });
}

bool photographs_are_alike(const TriMesh& mesh, double voxel_size, Inputs& inputs, Report& report,
                           Progress& progress) {
  const auto alike =
      find_alike(inputs.scene, mesh, voxel_size, report.noise_sigma, inputs.views, progress);
  if (!alike) return false;
  report.photometric = alike->json;
  report.photometric_line = alike->line;
  return true;
}

bool correct_photometric(Photometric mode, const TriMesh& mesh, double voxel_size, Inputs& inputs,
                         Report& report, Progress& progress) {
  const PhotometricOutcome found = pipeline::correct_photometric(
      mode, inputs.scene, mesh, voxel_size, report.noise_sigma, inputs.views, progress);
  report.photometric = found.json;
  report.photometric_line = found.line;
  if (!found.warning.empty()) inputs.warn(found.warning);
  return found.used;
}

}  // namespace photohull::pipeline

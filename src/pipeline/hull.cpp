#include "pipeline/hull.h"

#include <algorithm>
#include <cmath>

#include "carving/bounding.h"
#include "carving/fit_grid.h"
#include "carving/thin_parts.h"
#include "core/error.h"
#include "core/option_word.h"
#include "pipeline/checks.h"
#include "projtex/gpu_views.h"
#include "refine/refine.h"

namespace photohull::pipeline {
namespace {

constexpr double kBoxSlack = 0.5;              // voxels that the surface may stand out of the box
constexpr std::size_t kFewestThinVoxels = 32;  // a hull of fewer, all of them thin, is none
constexpr int kBoundingMargin = 2;             // coarse voxels around the box

}  // namespace

SparseVolume Hull::carve_box(const GridSpec& grid, const Box& inner) {
  const std::vector<carving::Silhouette> silhouettes = silhouettes_of(subject_.views);
  const std::vector<Camera> cameras = projtex::cameras_of(subject_.views);
  if (!textures_)
    textures_ =
        std::make_unique<carving::SilhouetteTextures>(carving::HullViews{cameras, silhouettes});
  carving::HullOptions hull_options;
  hull_options.min_views = any_mask(subject_.views) ? 1 : 2;
  hull_options.views_may_miss = options_.views_may_miss.value_or(0);
  hull_options.full_evidence = subject_.full_evidence;
  // Where hardly more views see a point than may leave it out, nothing would be known of it.
  if (hull_options.views_may_miss > 0)
    hull_options.min_views =
        std::min(hull_options.views_may_miss + 2, std::max(int(cameras.size()), 1));
  const double slack = options_.box.exact ? 0 : kBoxSlack * grid.voxel_size;
  const Box box{inner.min - slack, inner.max + slack};
  carving::HullReport counts;
  Progress silent(progress_.token());
  SparseVolume volume =
      carving::carve_silhouette(context_, {grid, box}, *textures_, hull_options, silent, &counts);
  const std::size_t thin =
      carving::keep_thin_parts(volume, box, cameras, silhouettes, hull_options);
  findings_.nodes_tested += counts.nodes_tested;
  findings_.bricks_evaluated += counts.bricks_evaluated;
  findings_.samples += counts.samples;
  const bool specks = !options_.carved_box && grid.voxel_size == subject_.grid.voxel_size &&
                      volume.inside_voxels() == thin &&
                      thin < kFewestThinVoxels;  // coarse grids, and parts, may hold no more of it
  return specks ? SparseVolume() : volume;
}

void Hull::release_textures() { textures_.reset(); }

SparseVolume Hull::carve(const GridSpec& grid) {
  SparseVolume volume = carve_box(grid, subject_.box);
  if (volume.inside_voxels() == 0)
    throw Error(explain_empty_hull(subject_.box, subject_.views, silhouettes_of(subject_.views),
                                   grid.voxel_size));
  return volume;
}

const Hull::Bounds& Hull::bounds() {
  if (bounds_) return *bounds_;
  GridSpec grid = subject_.grid;
  const auto longest = [](const glm::ivec3& n) { return std::max({n.x, n.y, n.z}); };
  while (longest(grid.voxels()) > refine::RefineOptions::kCoarsestVoxels)
    grid = carving::coarser(grid);
  // Outside the box an object that only fills it ends, and one that the box cuts off goes on.
  const double margin = kBoundingMargin * grid.voxel_size;
  const Box room{subject_.box.min - margin, subject_.box.max + margin};
  const SparseVolume hull = carve_box(carving::fit_grid(room, grid.voxel_size), room);
  if (hull.inside_voxels() == 0) carve(grid);  // tells why
  bounds_ = Bounds{carving::silhouettes_bound(hull, room, silhouettes_of(subject_.views)),
                   carving::share_at_box(hull, room)};
  return *bounds_;
}

bool Hull::bounded() {
  if (!any_mask(subject_.views)) return false;
  if (bounds().all) return true;
  const auto silhouettes = silhouettes_of(subject_.views);
  const auto masked = std::count_if(silhouettes.begin(), silhouettes.end(),
                                    [](const carving::Silhouette& v) { return v.distance; });
  progress_.warn(concat(
      "the masks do not bound the object: ",
      2 * std::size_t(masked) < silhouettes.size()
          ? concat("only ", masked, " of ", silhouettes.size(), " views have one")
          : concat("what they show goes on beyond the box on ",
                   std::lround(100 * bounds().share_beyond),
                   " % of its surface; is the box too small (", option_word("box", "auto"),
                   " finds one), or do the "
                   "masks show more than the object, or the cameras not see it from around?"),
      "; what no photograph tells of is left open, as without masks"));
  return false;
}

double Hull::share_beyond() { return any_mask(subject_.views) ? bounds().share_beyond : 1; }

}  // namespace photohull::pipeline

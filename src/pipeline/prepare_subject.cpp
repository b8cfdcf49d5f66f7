#include "pipeline/prepare_subject.h"

#include <malloc.h>

#include <utility>

#include "pipeline/cameras_stage.h"
#include "pipeline/find_silhouettes.h"
#include "pipeline/place_lattice.h"
#include "pipeline/prepare_scene.h"
#include "pipeline/read_scene.h"
#include "pipeline/stage_weights.h"

namespace photohull::pipeline {

Prepared prepare(Run& run) {
  const ReconstructOptions& options = run.options;
  const Photographs& photographs = run.photographs;
  Progress& progress = run.progress;
  Report& report = run.report;
  ReadScene read = run.clock.run("scene", Weights::kScene,
                                 [&] { return read_scene(photographs, options, progress); });
  report.scene = read.findings;
  run.clock.run("device", Weights::kDevice,
                [&] { run.context = gpu::Context::create(options.device, options.threads); });
  report.device = run.context->device().renderer;
  const bool box_found = read.box_found;
  const std::optional<Box> seen = read.seen;
  PreparedScene scene = run.clock.run("views", Weights::kViews, [&] {
    return prepare_scene(photographs, std::move(read), options, progress);
  });
  report.photographs = scene.findings;
  AgreeingCameras agreeing{std::move(scene.views), {}, {}};
  if (const double weight = Weights::cameras(options); weight > 0)
    agreeing = run.clock.run("cameras", weight, [&] {
      return find_cameras(options, run.earlier.given_rig(), scene.scene, std::move(agreeing.views),
                          progress);
    });
  report.cameras = agreeing.findings;
  const SourcedBox box =
      tighten_box(options, {*scene.scene.box, scene.scene.box_source}, agreeing.views, progress);
  const GridSpec grid =
      run.earlier.part ? run.earlier.part->grid : place_lattice(options, box, agreeing.views);
  std::vector<PreparedView> views = has_surroundings(options, box_found, agreeing.views)
                                        ? std::move(agreeing.views)
                                        : crop_views(std::move(agreeing.views), box.box);
  const bool masks = any_mask(views);
  malloc_trim(0);  // features, and whole photographs, are gone
  FoundSilhouettes found = run.clock.run("silhouettes", Weights::kSilhouettes, [&] {
    return find_silhouettes({options, box.box, agreeing.right, scene.findings}, std::move(views),
                            progress);
  });
  report.silhouettes = found.findings;
  report.full_evidence = found.full_evidence;
  const Part* part = run.earlier.given_part();
  if (part) found.views = views_of(*part, std::move(found.views));
  const Box carved = part ? part->box : box.box;
  report.box = carved;
  report.box_source = box.source;
  report.grid = grid;
  return {{carved, box.source, box_found, seen, grid, std::move(found.views),
           scene.findings.noise_sigma, scene.findings.mask_confidence, found.full_evidence,
           scene.held_bytes},
          masks,
          std::move(agreeing.findings),
          std::move(found.findings)};
}

ReconstructOptions options_of(const std::optional<Part>& part, ReconstructOptions options) {
  if (!part) return options;
  options.voxel_size = part->grid.voxel_size;
  options.box.exact = true;
  options.carved_box = part->box;
  options.part_bricks = part->bricks;
  options.report_page = ReportPage::kOff;
  options.tiles = {};
  return options;
}

Photographs photographs_of(const Part& part, Photographs photographs) {
  photographs.scene.box = part.whole_box;
  photographs.scene.box_source = "the whole";
  return photographs;
}

}  // namespace photohull::pipeline

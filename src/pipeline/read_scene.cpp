#include "pipeline/read_scene.h"

#include "core/error.h"
#include "core/option_word.h"
#include "pipeline/checks.h"
#include "pipeline/complete_box.h"
#include "pipeline/mask_policy.h"
#include "pipeline/memory.h"
#include "pipeline/plan.h"
#include "pipeline/view_order.h"

namespace photohull::pipeline {

std::int64_t memory_limit(const ReconstructOptions& options) {
  return options.max_memory ? *options.max_memory : default_max_memory();
}

ReadScene read_scene(const Photographs& photographs, const ReconstructOptions& options,
                     Progress& progress) {
  ReadScene out;
  out.scene = photographs.scene;
  Scene& scene = out.scene;
  sort_views_by_name(scene);
  out.findings = {scene.path.string(), to_string(scene.format), {}, int(scene.listed.size()),
                  scene.scaled,        scene.passed_over};
  if (options.lattice == Lattice::kFixed && looks_for_box(options.box, scene))
    throw Error(concat(scene.path.string(), ": ", option_word("lattice", "fixed"),
                       " needs a box that does not follow the photographs, and the "
                       "scene gives none; give ",
                       option_word("box")));
  const BoxFindings found = complete_box(options.box, mask_policy(photographs.load.masks), scene,
                                         progress, photographs.reader);
  out.box_found = found.found;
  out.seen = found.seen;
  for (const std::string& text : scene.warnings) progress.warn(text);
  for (const std::string& text : check_box(*scene.box, scene.box_source, scene.views))
    progress.warn(text);
  if (const auto why = hopeless_setup(*scene.box, scene.box_source, scene.views)) throw Error(*why);
  out.reading = choose_reading(photographs, scene, *scene.box, options, progress);
  if (photographs.digest.empty()) out.findings.inputs = hash_inputs(scene);
  return out;
}

Reading choose_reading(const Photographs& photographs, const Scene& scene, const Box& box,
                       const ReconstructOptions& options, Progress& progress) {
  // With masks neither the box nor how much surface it holds is known before these have been seen.
  const bool known = photographs.load.masks == io::MaskSource::kNone;
  const std::int64_t limit = memory_limit(options);
  Plan plan =
      plan_reading({options, photographs.load.masks, photographs.reader}, scene, box, known, limit);
  check_memory({plan.cost.bytes, plan.fixed_bytes, plan.grid.voxel_size}, limit);
  const bool short_of_memory = plan.scales != plan.wanted;
  if (plan.held_bytes > 0)
    progress.warn(concat("the photographs are held at ", smallest_scale_text(plan.scales),
                         " of their size, which outlines and colours come from, and the surface "
                         "is matched in some at a time at ",
                         smallest_scale_text(plan.wanted),
                         " of it: all of these would take more than ", memory_text(limit),
                         " of memory (", option_word("max_memory"), ")"));
  else if (short_of_memory)
    progress.warn(concat("the photographs are read at ", smallest_scale_text(plan.scales),
                         " of their size: at ", smallest_scale_text(plan.wanted),
                         " the job would take more than ", memory_text(limit), " of memory (",
                         option_word("max_memory"), "; ", option_word("image_scale"),
                         " forces a size)"));
  std::vector<double> matched = plan.held_bytes > 0 ? std::move(plan.wanted) : plan.scales;
  return {std::move(plan.scales), short_of_memory, std::move(matched), plan.held_bytes};
}

}  // namespace photohull::pipeline

#include "pipeline/find_silhouettes.h"

#include "pipeline/silhouette_steps.h"

namespace photohull::pipeline {

FoundSilhouettes find_silhouettes(const SilhouetteJob& job, std::vector<PreparedView> views,
                                  Progress& progress) {
  using namespace silhouettes;
  FoundSilhouettes out{std::move(views), 0, {}};
  SilhouetteFindings& findings = out.findings;
  measure_distances(out.views);
  leave_out_blurred(job, out.views, findings, progress);
  const bool restored = correct_masks(job, out.views, findings, progress);
  Outlines outlines = trace_outlines(out.views);
  leave_out_wrong_views(job, out.views, outlines, findings, progress);
  const Room room = bear_disagreement(job, out.views, outlines, restored, findings, progress);
  give_room(room, out.views, findings);
  out.full_evidence = explain_foreground(job, room.full_evidence, out.views, findings, progress);
  return out;
}

}  // namespace photohull::pipeline

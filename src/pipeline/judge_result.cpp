#include "pipeline/judge_result.h"

#include <algorithm>

#include "pipeline/explained_picture.h"
#include "pipeline/self_check.h"

namespace photohull::pipeline {

Judgement judge_result(const SurfaceJob& job, const Judged& judged, bool pictures) {
  const Subject& subject = job.subject;
  const ThinFindings& thin = judged.silhouettes.thin;
  const double share_beyond = job.hull.share_beyond();
  job.hull.release_textures();
  job.context.release_deleted();
  const CheckedResult result{
      .mesh = &judged.mesh,
      .box = &subject.box,
      .around = &judged.around.mesh,
      .around_box = &judged.around.box,
      .voxel_size = subject.grid.voxel_size,
      .hull = method_of(job.options).by_silhouettes,
      .bounded = job.bounded,
      .share_beyond = share_beyond,
      .views = subject.views,
      .mask_confidence = subject.mask_confidence,
      .noise_sigma = subject.noise_sigma,
      .stems = double(judged.stem_vertices) /
               double(std::max<std::size_t>(judged.mesh.positions.size(), 1)),
      .stems_restored =
          double(thin.restored_pixels) / double(std::max<std::int64_t>(thin.line_pixels, 1)),
      .contradiction = judged.silhouettes.contradiction,
      .common = judged.silhouettes.common_error,
      .cameras_moved = judged.cameras.moved,
      .cameras_moved_alike = judged.cameras.moved_alike};
  std::vector<assess::SilhouetteFit> fits;
  const assess::Signals signals = gather_signals(result, &fits);
  std::vector<std::string> names;
  for (const PreparedView& view : subject.views) names.push_back(view.name);
  Judgement out;
  out.findings.verdict = assess::judge(signals, names);
  out.findings.json = to_json(out.findings.verdict, signals, subject.views, fits);
  if (!pictures) return out;
  out.missing = draw_missing(result, fits);
  out.explained = draw_explained(subject.views, signals.explained);
  out.findings.missing_view = out.missing.view;
  out.findings.explained_view = out.explained.view;
  return out;
}

}  // namespace photohull::pipeline

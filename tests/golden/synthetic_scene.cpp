#include "golden/synthetic_scene.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "io/mesh/write_mesh.h"
#include "support/places.h"
#include "synth/synthesize.h"

namespace photohull::golden {
namespace {

synth::Spec small_spec(const std::string& name, int views, int width, int height) {
  synth::Spec spec = synth::read_spec(test::in_checkout("datasets/synthetic/" + name + ".json"));
  synth::set_view_count(spec.cameras, views);
  spec.image.width = width;
  spec.image.height = height;
  spec.truth_samples = 50000;
  return spec;
}

eval::Truth make_scene(const synth::Spec& spec, const std::filesystem::path& folder) {
  Progress silent;
  synth::synthesize(spec, folder, silent);
  return eval::read_truth(folder);
}

}  // namespace

SyntheticScene::SyntheticScene(const std::string& name, int views, int width, int height)
    : SyntheticScene(small_spec(name, views, width, height)) {}

SyntheticScene::SyntheticScene(const synth::Spec& spec)
    : truth_(make_scene(spec, folder_ / "scene")) {}

eval::Evaluation SyntheticScene::reconstruct(pipeline::Method method, int resolution,
                                             std::optional<projtex::Sampler> sampler) const {
  pipeline::ReconstructOptions options;
  options.resolution = resolution;
  options.method = method;
  options.sampler = sampler;
  options.device = "software";
  Progress silent;
  const pipeline::Reconstruction result =
      pipeline::Reconstructor(options).run(pipeline::load_photographs(folder_ / "scene"), silent);
  eval::EvaluateOptions judge;
  judge.samples = 50000;
  judge.columns = 64;
  return eval::evaluate(result.mesh, truth_, judge);
}

double f_score(const eval::Evaluation& evaluation, double threshold_percent) {
  for (const eval::Score& score : evaluation.seen.scores)
    if (std::abs(100 * score.threshold - threshold_percent) < 1e-9) return 100 * score.f;
  throw std::invalid_argument("no such threshold");
}

std::string summary(const eval::Evaluation& evaluation) {
  char line[160];
  std::snprintf(line, sizeof line,
                "F %.2f at 0.5 %%, %.2f at 1 %%; mean error %.6f of the diagonal",
                f_score(evaluation, 0.5), f_score(evaluation, 1),
                evaluation.seen.to_truth.mean / evaluation.truth_diagonal);
  return line;
}

}  // namespace photohull::golden

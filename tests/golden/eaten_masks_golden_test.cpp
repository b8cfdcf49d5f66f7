// Stems that the masks' maker ate, by a pixel around every outline, come back from the photographs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "eval/evaluate.h"
#include "pipeline/reconstruct.h"
#include "support/scratch_folder.h"
#include "synth/synthesize.h"

namespace photohull::golden {
namespace {

struct Result {
  pipeline::Report report;
  double f = 0;  ///< percent, at 1 % of the diagonal
};

Result run(const std::string& degradations, const std::string& background, int pixels = 448) {
  const ScratchFolder folder;
  Progress silent;
  const std::string common = R"({"geometry": {"shape": "seedling", "parameters": {"shoot": 0.0014}},
      "material": {"base": [0.24, 0.45, 0.14], "contrast": 0.6, "size": 0.02},
      "image": {"samples": 4, "maps": false}, "truth_samples": 20000,
      "cameras": {"rings": [{"count": 8, "elevation": 10},
                            {"count": 4, "elevation": 35, "phase": 0.5}]},)";
  synth::Spec spec = synth::parse_spec(
      common + "\"background\": " + background + ", \"degradations\": " + degradations + "}",
      "test", "");
  spec.image.width = spec.image.height = pixels;
  synth::synthesize(spec, folder / "scene", silent);
  pipeline::ReconstructOptions options;
  options.method = pipeline::Method::kHull;
  options.device = "software";
  const pipeline::Reconstruction made =
      pipeline::Reconstructor(options).run(pipeline::load_photographs(folder / "scene"), silent);
  Result result{made.report};
  eval::EvaluateOptions judge;
  judge.samples = 20000;
  judge.columns = 64;
  const eval::Evaluation e = eval::evaluate(made.mesh, eval::read_truth(folder / "scene"), judge);
  for (const eval::Score& score : e.seen.scores)
    if (score.threshold == 0.01) result.f = 100 * score.f;
  std::printf("F %.2f at 1 %%, %lld px restored\n", result.f,
              (long long)(result.report.silhouettes.thin.restored_pixels));
  return result;
}

constexpr const char* kPlain = R"({"colour": [0.03, 0.03, 0.04]})";
constexpr const char* kEroded = R"({"mask_style": "eroded"})";

TEST(EatenMasks, StemsComeBackBeforePlainGround) {
  const Result r = run(kEroded, kPlain);
  EXPECT_GT(r.report.silhouettes.mask_offset, 0.5);
  EXPECT_GT(r.report.silhouettes.thin.restored_pixels, 4000);
  EXPECT_GT(r.f, 95);
}

TEST(EatenMasks, StemsComeBackBeforeClutterThatMoves) {
  const Result r = run(kEroded, R"({"type": "clutter", "moving": true})");
  EXPECT_GT(r.report.silhouettes.thin.restored_pixels, 2000);
  EXPECT_GT(r.f, 85);
}

TEST(EatenMasks, NothingIsPutBackIntoMasksThatAreRight) {
  const Result r = run("{}", kPlain);
  EXPECT_EQ(r.report.silhouettes.mask_offset, 0);
  EXPECT_EQ(r.report.silhouettes.thin.restored_pixels, 0);
}

/// Stems of 0.1 to 0.3 pixels, whose tips each view loses elsewhere.
TEST(EatenMasks, StemsFarBelowAPixelAreNotEatenAndMoveNoCameras) {
  const Result r = run("{}", kPlain, 180);
  EXPECT_EQ(r.report.silhouettes.mask_offset, 0);
  EXPECT_GT(r.report.cameras.mask_disagreement, 0.25);  // so that refining the cameras is tried
  EXPECT_THAT(r.report.cameras.refinement, testing::HasSubstr("\"used\": false"));
  EXPECT_GT(r.f, 90);
}

}  // namespace
}  // namespace photohull::golden

// The study's figures where the answer is known.
#include "lab/visibility/study.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "support/gl_context.h"

namespace photohull::visibility {
namespace {

TEST(VisibilityStudy, ListsAreExactAndAPlainMapIsNot) {
  StudyOptions options;
  options.scenes = {"ball"};
  options.resolutions = {64};
  options.techniques = {"plain", "lists"};
  options.width = 80, options.height = 60, options.silhouettes = 30, options.repeats = 1;
  Progress progress;
  const Study study = study_visibility(test::gl_context(), options, progress);
  ASSERT_EQ(study.cells.size(), 2u);
  const StudyCell &plain = study.cells[0], &lists = study.cells[1];
  EXPECT_GT(plain.errors.total(), 0.3);
  EXPECT_LE(lists.errors.total(), 0.1 * plain.errors.total());
  EXPECT_GT(plain.silhouette_texels, 0.1);
  EXPECT_LT(lists.silhouette_texels, 0.05);
  EXPECT_GT(plain.map_ms, 0);
  EXPECT_EQ(plain.bytes, 64 * 64 * 4);
  // Acne falls and leaks grow with the bias.
  EXPECT_GT(study.biases.front().errors.false_occlusion,
            study.biases.back().errors.false_occlusion);
  EXPECT_LE(study.biases.front().errors.false_visibility,
            study.biases.back().errors.false_visibility);
  for (const DetectionCell& cell : study.detection) {
    if (cell.technique == "lists") {
      EXPECT_GE(cell.found_percent, 99) << cell.resolution;
    } else {
      EXPECT_LT(cell.found_percent, 95) << cell.technique;
    }
  }
  EXPECT_TRUE(study.left_out.empty());
}

TEST(VisibilityStudy, RefusesWhatDoesNotExist) {
  StudyOptions options;
  options.scenes = {"moon"};
  EXPECT_THROW(options.validate(), UsageError);
  EXPECT_THROW(make_study_scene("moon"), UsageError);
}

}  // namespace
}  // namespace photohull::visibility

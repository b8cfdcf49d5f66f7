// r-consistency in the photo-consistency kernel against its reference.
#include <gtest/gtest.h>

#include "carving/search_disc.h"
#include "carving/statistic.h"
#include "carving/sweep_kernels.h"
#include "support/cameras.h"
#include "support/gl_context.h"

namespace photohull::carving {
namespace {

using reference::ShownPatch;
using test_kernels::SweepKernels;

constexpr double kNoiseVariance = 1e-4;
constexpr double kScoreBound = 1e-4;
constexpr double kCertain = 1e-4;  // of choices, in correlations

class SearchTest : public ::testing::Test {
 protected:
  static constexpr int kViews = 6, kShifts = 7;

  SearchTest() {
    bits_.grid = {{0, 0, 0}, 1, {1, 1, 1}};
    bits_.table = {0};
    bits_.bricks = {{0, 0, 0}};
    bits_.words.assign(BitVolume::kWords, ~0u);
    for (int i = 0; i < kViews; ++i)
      cameras_.push_back(
          projtex::to_grid(test::random_camera(rng_, bits_.grid.bounds(), 64, 64), bits_.grid));
  }
  void TearDown() override { context_.check_errors("search test"); }

  SweepKernels kernels(bool coverage) {
    const auto offsets = search_disc(1);
    EXPECT_EQ(offsets.size(), std::size_t(kShifts));
    SweepKernels out(context_, bits_, {2, 1, {8, 8, 8}}, cameras_,
                     statistic_defines(Statistic::kZncc, coverage) + search_defines(offsets),
                     kShifts);
    out.parameters.noise = {kNoiseVariance, 0, 0, 0};
    out.select(0);
    return out;
  }

  glm::vec4 random_colour() {
    const double r = test::uniform(rng_, 0, 1), g = test::uniform(rng_, 0, 1);
    return {r, g, test::uniform(rng_, 0, 1), 1};
  }

  /// A pattern that each view shows at a shift of its own, and noise at the others.
  std::vector<glm::vec4> hidden_pattern(const SweepKernels& kernels) {
    std::vector<glm::vec4> pattern(shaders::kApronArea), samples(kernels.sample_count());
    for (glm::vec4& p : pattern) p = random_colour();
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const auto area = i / shaders::kApronArea;
      const int view = int(area / kShifts), shift = int(area % kShifts);
      const bool shown = shift == (view < 2 ? 0 : view % kShifts);
      samples[i] = shown ? glm::mix(pattern[i % shaders::kApronArea], random_colour(), 0.1f)
                         : random_colour();
    }
    return samples;
  }

  ShownPatch patch_of(const SweepKernels& kernels, std::size_t judged, int view, int shift,
                      const std::vector<glm::vec4>& samples) const {
    ShownPatch patch;
    for (int tap = 0; tap < reference::kPatchTaps; ++tap)
      patch[tap] = samples[kernels.patch_base(judged, view, shift) + tap / 5 * shaders::kApronEdge +
                           tap % 5];
    return patch;
  }

  /// Scores of the patches that the reference chooses, on the taps that all of them show.
  reference::Consistency expected(const std::vector<std::vector<ShownPatch>>& views,
                                  const std::vector<int>& shifts) const {
    std::vector<std::vector<glm::dvec3>> colours;
    for (int tap = 0; tap < reference::kPatchTaps; ++tap) {
      bool common = true;
      for (int v = 0; v < kViews; ++v)
        common = common && (shifts[v] < 0 || views[v][shifts[v]][tap].a > 0);
      std::size_t at = 0;
      for (int v = 0; v < kViews; ++v) {
        if (shifts[v] < 0) continue;
        if (colours.size() == at) colours.emplace_back();
        if (common) colours[at].emplace_back(views[v][shifts[v]][tap]);
        ++at;
      }
    }
    const std::vector<reference::PatchColours> patches(colours.begin(), colours.end());
    return reference::photo_consistency(patches, kNoiseVariance);
  }

  void compare(const SweepKernels& kernels, const std::vector<glm::vec4>& samples,
               const std::vector<glm::vec4>& found, bool coverage) {
    for (std::size_t i = 0; i < found.size(); ++i) {
      std::vector<std::vector<ShownPatch>> views(kViews);
      for (int v = 0; v < kViews; ++v)
        for (int shift = 0; shift < kShifts; ++shift)
          views[v].push_back(patch_of(kernels, i, v, shift, samples));
      const auto searched = reference::choose_shifts(views, kNoiseVariance, coverage);
      if (searched.margin < kCertain) continue;  // rounding may choose otherwise
      const auto score = expected(views, searched.shifts);
      EXPECT_EQ(found[i].w, score.seen);
      if (score.outlier_margin < 10 * kScoreBound) continue;
      EXPECT_NEAR(found[i].x, score.score, kScoreBound);
      EXPECT_EQ(found[i].y, score.used);
      ++compared_;
    }
  }

  gpu::Context& context_ = test::gl_context();
  test::Rng rng_{53};
  BitVolume bits_;
  std::vector<projtex::GridCamera> cameras_;
  int compared_ = 0;
};

TEST_F(SearchTest, FindsThePatternWhereverTheDiscShowsIt) {
  SweepKernels kernels = this->kernels(false);
  const auto samples = hidden_pattern(kernels);
  const auto found = kernels.score(samples);
  compare(kernels, samples, found, false);
  EXPECT_GT(compared_, 50);
  for (const glm::vec4& score : found) {
    EXPECT_EQ(score.y, kViews);
    EXPECT_GT(score.x, 0.9);
  }
}

TEST_F(SearchTest, DiscsThatLeaveTheImageOrTheMask) {
  for (const bool coverage : {false, true}) {
    SweepKernels kernels = this->kernels(coverage);
    auto samples = hidden_pattern(kernels);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const auto area = i / shaders::kApronArea;
      const int view = int(area / kShifts), shift = int(area % kShifts);
      // View 4 shows nothing at all, view 3 nothing but the right shift, view 0 loses a sample.
      if (view == 4 || (view == 3 && shift != 3)) samples[i].a = -1;
      if (view == 0 && shift < 3 && i % shaders::kApronArea == 53) samples[i].a = -1;
      if (coverage && test::uniform(rng_, 0, 1) < 0.01) samples[i] = glm::vec4(0);
    }
    const int before = compared_;
    const auto found = kernels.score(samples);
    compare(kernels, samples, found, coverage);
    EXPECT_GT(compared_ - before, 40);
    for (const glm::vec4& score : found) EXPECT_LT(score.w, kViews);
  }
}

TEST_F(SearchTest, PlainPatchesNeverAgree) {
  SweepKernels kernels = this->kernels(false);
  const std::vector<glm::vec4> samples(kernels.sample_count(), glm::vec4(0.4f, 0.4f, 0.4f, 1));
  for (const glm::vec4& score : kernels.score(samples)) EXPECT_LT(score.x, 1e-3);
}

}  // namespace
}  // namespace photohull::carving

#include "lab/sampling/sampling_study.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "support/gl_context.h"

namespace photohull::projtex {
namespace {

StudyOptions small() {
  StudyOptions o;
  o.footprints = {0.5, 4};
  o.ratios = {1, 8};
  o.supersamples = {1, 4};
  o.squares = 32;
  return o;
}

const StudyCell& cell_of(const std::vector<StudyCell>& cells, Sampler sampler, int supersample,
                         double footprint, double ratio) {
  for (const StudyCell& c : cells)
    if (c.sampler == sampler && c.supersample == supersample && c.footprint == footprint &&
        c.ratio == ratio)
      return c;
  throw Error("no such cell");
}

TEST(SamplingStudy, RanksTheSamplersAsTheTheoryDoes) {
  Progress silent;
  const auto cells = study_samplers(test::gl_context(), small(), silent);
  for (const StudyCell& c : cells) {
    EXPECT_GT(c.rms, 0);
    EXPECT_GE(c.percentile99, c.rms);
    EXPECT_GT(c.nanoseconds, 0);
  }
  const auto rms = [&](Sampler s, int n, double f, double r) {
    return cell_of(cells, s, n, f, r).rms;
  };
  for (const double footprint : {0.5, 4.0})
    for (const double ratio : {1.0, 8.0}) EXPECT_LT(rms(Sampler::kEwa, 4, footprint, ratio), 1);
  // Point samples alias when many pixels fall into a footprint; isotropic filters blur long ones.
  EXPECT_GT(rms(Sampler::kBilinear, 1, 4, 1), 2 * rms(Sampler::kTrilinear, 1, 4, 1));
  EXPECT_GT(rms(Sampler::kTrilinear, 1, 4, 8), 2 * rms(Sampler::kAnisotropic, 1, 4, 8));
  EXPECT_GT(rms(Sampler::kNearest, 1, 4, 1), rms(Sampler::kNearest, 4, 4, 1));
}

TEST(SamplingStudy, CountsOutOfRangeAreRefused) {
  StudyOptions options;
  for (const int bad : {0, 15, 100001}) {
    options.squares = bad;
    EXPECT_THROW(options.validate(), UsageError);
  }
}

}  // namespace
}  // namespace photohull::projtex

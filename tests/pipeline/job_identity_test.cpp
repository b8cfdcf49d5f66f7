// Which jobs may go on from each other's checkpoints.
#include "pipeline/job_identity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "described_options.h"

namespace photohull::pipeline {
namespace {

std::string identity_of(const ReconstructOptions& options, const io::LoadSceneOptions& load = {}) {
  return job_identity(options, {.load = load}, {}, "device");
}

TEST(JobIdentity, DiffersByPhotographsViewsAndLattices) {
  using Change = std::function<void(Photographs&, Subject&)>;
  const Change changes[] = {
      [](Photographs&, Subject&) {},
      [](Photographs& p, Subject&) { p.digest = "of other pixels"; },
      [](Photographs&, Subject& s) { s.box.max.x += 1e-12; },
      [](Photographs&, Subject& s) { s.views[1].source.camera.intrinsics.cx += 1e-9; },
      [](Photographs&, Subject& s) { s.views.pop_back(); },
      [](Photographs&, Subject& s) { s.grid.voxel_size = 0.5; },
  };
  std::set<std::string> identities;
  for (const Change& change : changes) {
    Photographs photographs;
    Subject subject;
    subject.box = Box{glm::dvec3(-1), glm::dvec3(1)};
    subject.views.resize(3);
    change(photographs, subject);
    const std::string identity = job_identity({}, photographs, subject, "device");
    EXPECT_EQ(identity, job_identity({}, photographs, subject, "device"));
    EXPECT_NE(identity, job_identity({}, photographs, subject, "another device"));
    EXPECT_TRUE(identities.insert(identity).second) << identities.size();
  }
}

TEST(JobIdentity, DiffersByEveryOptionThatRefinementRestsOnAndByNoOther) {
  const std::string usual = identity_of({});
  ReconstructOptions none;
  io::LoadSceneOptions no_load;
  Described all;
  describe(all, none, no_load);
  for (const Option& option : all.options()) {
    ReconstructOptions options;
    io::LoadSceneOptions load;
    Described described;
    describe(described, options, load);
    const Option& changed = *described.find(option.name);
    change(changed);
    ASSERT_NE(text_of(changed), text_of(option)) << option.name;
    EXPECT_EQ(identity_of(options, load) != usual, option.from <= Stage::kSurface) << option.name;
  }
  for (const char* name : {"threads", "evidence", "fresh", "mesh_error", "unseen"})
    EXPECT_GT(all.find(name)->from, Stage::kSurface) << name;
  ReconstructOptions elsewhere;
  elsewhere.checkpoint = "elsewhere";
  EXPECT_EQ(identity_of(elsewhere), usual);
}

TEST(JobIdentity, DiffersByEveryParameterThatRefinementRestsOnAndByNoOther) {
  ReconstructOptions options;
  options.method = Method::kRefine;
  const std::string usual = identity_of(options);
  Parameters parameters;
  Described all;
  describe(all, Method::kRefine, parameters);
  for (const Option& option : all.options()) {
    if (!option_that_sets(option.name).empty()) continue;
    options.tune = {assignment_of(option)};
    tuned(options);
    EXPECT_EQ(identity_of(options) != usual, option.from <= Stage::kSurface) << option.name;
  }
  for (const char* name : {"sharpen.reach", "stems.least_views"})
    EXPECT_EQ(all.find(name)->from, Stage::kMesh) << name;
}

TEST(JobIdentity, DiffersByTheLastDigitOfANumber) {
  ReconstructOptions options;
  options.noise = 3;
  const std::string identity = identity_of(options);
  options.noise = std::nextafter(3.0, 4.0);
  EXPECT_NE(identity_of(options), identity);
}

}  // namespace
}  // namespace photohull::pipeline

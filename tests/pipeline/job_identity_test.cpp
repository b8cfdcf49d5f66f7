// Which jobs may go on from each other's checkpoints.
#include "pipeline/job_identity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "described_options.h"

namespace photohull::pipeline {
namespace {

std::string identity_of(const ReconstructOptions& options) {
  Scene scene;
  scene.box = Box{glm::dvec3(-1), glm::dvec3(1)};
  return job_identity(options, scene, {}, "device");
}

TEST(JobIdentity, DiffersByScenesAndLattices) {
  using Change = std::function<void(Scene&, GridSpec&)>;
  const Change changes[] = {
      [](Scene&, GridSpec&) {},
      [](Scene& s, GridSpec&) { s.box->max.x += 1e-12; },
      [](Scene& s, GridSpec&) { s.views[1].camera.intrinsics.cx += 1e-9; },
      [](Scene& s, GridSpec&) { s.views.pop_back(); },
      [](Scene&, GridSpec& g) { g.voxel_size = 0.5; },
  };
  std::set<std::string> identities;
  for (const Change& change : changes) {
    Scene scene;
    scene.box = Box{glm::dvec3(-1), glm::dvec3(1)};
    scene.views.resize(3);
    GridSpec grid;
    change(scene, grid);
    const std::string identity = job_identity({}, scene, grid, "device");
    EXPECT_EQ(identity, job_identity({}, scene, grid, "device"));
    EXPECT_NE(identity, job_identity({}, scene, grid, "another device"));
    EXPECT_TRUE(identities.insert(identity).second) << identities.size();
  }
}

TEST(JobIdentity, DiffersByEveryOptionThatRefinementRestsOnAndByNoOther) {
  const std::string usual = identity_of({});
  ReconstructOptions none;
  Described all;
  describe(all, none);
  for (const Option& option : all.options()) {
    ReconstructOptions options;
    Described described;
    describe(described, options);
    const Option& changed = *described.find(option.name);
    change(changed);
    ASSERT_NE(text_of(changed), text_of(option)) << option.name;
    EXPECT_EQ(identity_of(options) != usual, option.from <= Stage::kSurface) << option.name;
  }
  for (const char* name : {"threads", "evidence", "fresh", "mesh_error", "unseen"})
    EXPECT_GT(all.find(name)->from, Stage::kSurface) << name;
  ReconstructOptions elsewhere;
  elsewhere.output = "elsewhere";
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

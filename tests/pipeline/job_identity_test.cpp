// Which jobs may go on from each other's checkpoints.
#include "pipeline/job_identity.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

namespace photohull::pipeline {
namespace {

TEST(JobIdentity, DiffersByWhatRefinementRestsOn) {
  using Change = std::function<void(ReconstructOptions&, Scene&, GridSpec&)>;
  const Change changes[] = {
      [](ReconstructOptions&, Scene&, GridSpec&) {},
      [](ReconstructOptions& o, Scene&, GridSpec&) { o.quality = Quality::kHigh; },
      [](ReconstructOptions& o, Scene&, GridSpec&) { o.load.masks = io::MaskSource::kNone; },
      [](ReconstructOptions& o, Scene&, GridSpec&) { o.photometric = Photometric::kOn; },
      [](ReconstructOptions& o, Scene&, GridSpec&) { o.mask_offset = 0; },
      [](ReconstructOptions& o, Scene&, GridSpec&) { o.noise = 3; },
      [](ReconstructOptions& o, Scene&, GridSpec&) { o.keep_mask_holes = true; },
      [](ReconstructOptions& o, Scene&, GridSpec&) { o.mask_offset = 1.5; },
      [](ReconstructOptions& o, Scene&, GridSpec&) { o.views_may_miss = 0; },
      [](ReconstructOptions& o, Scene&, GridSpec&) { o.views_may_miss = 2; },
      [](ReconstructOptions& o, Scene&, GridSpec&) { o.keep_views = true; },
      [](ReconstructOptions& o, Scene&, GridSpec&) { o.tune = {"settle.flat=0"}; },
      [](ReconstructOptions&, Scene& s, GridSpec&) { s.box->max.x += 1e-12; },
      [](ReconstructOptions&, Scene& s, GridSpec&) { s.views[1].camera.intrinsics.cx += 1e-9; },
      [](ReconstructOptions&, Scene& s, GridSpec&) { s.views.pop_back(); },
      [](ReconstructOptions&, Scene&, GridSpec& g) { g.voxel_size = 0.5; },
  };
  std::set<std::string> identities;
  for (const Change& change : changes) {
    ReconstructOptions options;
    Scene scene;
    scene.box = Box{glm::dvec3(-1), glm::dvec3(1)};
    scene.views.resize(3);
    GridSpec grid;
    change(options, scene, grid);
    const std::string identity = job_identity(options, scene, grid, "device");
    EXPECT_EQ(identity, job_identity(options, scene, grid, "device"));
    EXPECT_TRUE(identities.insert(identity).second) << identities.size();
  }
}

TEST(JobIdentity, IsTheSameForWhatComesAfterRefinement) {
  ReconstructOptions options;
  Scene scene;
  scene.box = Box{glm::dvec3(-1), glm::dvec3(1)};
  const std::string identity = job_identity(options, scene, {}, "device");
  options.mesh_error.value = 0.5;
  options.unseen = Unseen::kOpen;
  options.evidence = true;
  EXPECT_EQ(job_identity(options, scene, {}, "device"), identity);
}

}  // namespace
}  // namespace photohull::pipeline

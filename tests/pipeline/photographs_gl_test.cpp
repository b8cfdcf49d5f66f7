// Photographs in memory: what is refused, and that they give what the same files give.
#include "pipeline/photographs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "pipeline/reconstruct.h"
#include "support/scratch_folder.h"
#include "synth/synthesize.h"

namespace photohull::pipeline {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

MemoryPhotograph grey(const std::string& name, int width = 4, int height = 3) {
  MemoryPhotograph p;
  p.name = name;
  p.image.width = p.camera.intrinsics.width = width;
  p.image.height = p.camera.intrinsics.height = height;
  p.image.bytes.assign(std::size_t(4 * width * height), 128);
  return p;
}

/// Refused with a sentence that has `why`.
void expect_refused(MemoryPhotograph p, const std::string& why) {
  EXPECT_THAT([&] { photographs_in_memory({std::move(p)}); }, ThrowsMessage<Error>(HasSubstr(why)));
}

TEST(PhotographsInMemory, WhatDoesNotFitIsNamed) {
  expect_refused(grey(""), "has no name");
  MemoryPhotograph p = grey("a");
  p.camera.intrinsics.width = 5;
  expect_refused(p, "photograph 'a': the picture has 4x3 pixels but its camera is for 5x3");
  p = grey("b");
  p.image.bytes.pop_back();
  expect_refused(p, "photograph 'b': the picture needs 48 bytes and has 47");
  p = grey("c");
  p.mask = {4, 2, std::vector<std::uint8_t>(8, 255)};
  expect_refused(p, "photograph 'c': the mask has 4x2 pixels and 8 values, the picture 4x3");
  EXPECT_THAT(
      [] {
        photographs_in_memory({grey("d"), grey("d")});
      },
      ThrowsMessage<Error>(HasSubstr("another one has the same name")));
}

TEST(PhotographsInMemory, AreToldApartByTheirPixels) {
  MemoryPhotograph other = grey("a");
  other.image.bytes[5] = 129;
  EXPECT_EQ(photographs_in_memory({grey("a")}).digest, photographs_in_memory({grey("a")}).digest);
  EXPECT_NE(photographs_in_memory({grey("a")}).digest, photographs_in_memory({other}).digest);
}

class BlockScene : public testing::Test {
 protected:
  BlockScene() {
    synth::Spec spec = synth::parse_spec(R"({"geometry": {"shape": "block"}, "truth_samples": 100,
        "material": {"faces": true, "contrast": 0.6},
        "cameras": {"rings": [{"count": 8, "elevation": 10}, {"count": 6, "elevation": 40}]}})",
                                         "test", "");
    spec.image = {160, 120, 2};
    synth::synthesize(spec, folder_ / "scene", silent_);
  }

  Photographs in_memory(const Photographs& files) const {
    std::vector<MemoryPhotograph> all;
    for (const SourceView& view : files.scene.views)
      all.push_back({view.name, view.camera, files.reader.image(view.image, 1),
                     files.reader.mask(view.mask, glm::dvec2(1)), view.distortion});
    return photographs_in_memory(std::move(all), files.scene.box);
  }

  ScratchFolder folder_;
  Progress silent_;
};

TEST_F(BlockScene, GivesTheSameFromFilesAndFromMemory) {
  const Photographs files = load_photographs(folder_ / "scene");
  for (const char* scale : {"", "1/2"}) {
    ReconstructOptions options;
    options.resolution = 24;
    if (*scale) options.image_scale = 0.5;
    const Reconstructor reconstructor(options);
    const Reconstruction a = reconstructor.run(files, silent_);
    const Reconstruction b = reconstructor.run(in_memory(files), silent_);
    EXPECT_EQ(a.volume.distance, b.volume.distance);
    EXPECT_EQ(a.mesh.positions, b.mesh.positions);
    EXPECT_EQ(a.mesh.colours, b.mesh.colours);
    EXPECT_FALSE(a.report.scene.inputs.empty());
    EXPECT_TRUE(b.report.scene.inputs.empty());
    EXPECT_TRUE(a.report.files.empty());
  }
}

TEST_F(BlockScene, StopsByItsOwnToken) {
  const CancellationToken token;
  token.cancel();
  Progress stopped(token);
  ReconstructOptions options;
  EXPECT_THROW(Reconstructor(options).run(load_photographs(folder_ / "scene"), stopped), Cancelled);
}

TEST(Reconstructor, RefusesOptionsAtOnce) {
  ReconstructOptions options;
  options.resolution = 1;
  EXPECT_THROW(Reconstructor{options}, UsageError);
}

}  // namespace
}  // namespace photohull::pipeline

#include "gpu/program_resources.h"

#include <gmock/gmock.h>

namespace photohull::gpu {
namespace {

using testing::HasSubstr;

TEST(ProgramResources, WhatEveryDeviceHasIsWithinThePromise) {
  ProgramResources r;
  r.compute = {8, 16, 8};
  r.vertex = {0, 16, 0};
  r.highest_storage_binding = 7;
  r.highest_image_unit = 7;
  r.highest_texture_unit = 95;
  r.uniform_components = 1024;
  r.uniform_block_bytes = 16384;
  r.group = {16, 1, 64};
  EXPECT_EQ(beyond_promise(r), "");
}

TEST(ProgramResources, EachNumberBeyondThePromiseIsNamed) {
  const auto with = [](auto change) {
    ProgramResources r;
    change(r);
    return beyond_promise(r);
  };
  using R = ProgramResources;
  EXPECT_EQ(with([](R& r) { r.compute.storage_blocks = 9; }),
            "9 storage blocks in a compute shader (at most 8)");
  EXPECT_THAT(with([](R& r) { r.vertex.storage_blocks = 1; }),
              HasSubstr("vertex shader (at most 0)"));
  EXPECT_THAT(with([](R& r) { r.fragment.storage_blocks = 9; }), HasSubstr("fragment shader"));
  EXPECT_THAT(with([](R& r) { r.compute.textures = 17; }), HasSubstr("17 textures"));
  EXPECT_THAT(with([](R& r) { r.fragment.images = 9; }), HasSubstr("9 images"));
  EXPECT_THAT(with([](R& r) { r.vertex.images = 1; }), HasSubstr("1 images in a vertex shader"));
  EXPECT_THAT(with([](R& r) { r.highest_storage_binding = 8; }), HasSubstr("9 bindings"));
  EXPECT_THAT(with([](R& r) { r.highest_image_unit = 8; }), HasSubstr("9 image units"));
  EXPECT_THAT(with([](R& r) { r.uniform_components = 1025; }), HasSubstr("1025 numbers"));
  EXPECT_THAT(with([](R& r) { r.uniform_block_bytes = 16400; }), HasSubstr("16400 bytes"));
  EXPECT_THAT(with([](R& r) { r.group = {1, 1, 65}; }), HasSubstr("along z (at most 64)"));
  EXPECT_EQ(with([](R& r) {
              r.group = {64, 32, 1};
            }),
            "2048 invocations of a group (at most 1024)");
}

}  // namespace
}  // namespace photohull::gpu

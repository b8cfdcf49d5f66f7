#include "gpu/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "gpu/buffer.h"
#include "gpu/program_resources.h"
#include "gpu/shader_source.h"
#include "support/gl_context.h"

namespace photohull::gpu {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

TEST(Program, EveryEmbeddedComputeShaderCompilesOnTheDevice) {
  Context& context = test::gl_context();
  int count = 0;
  for (const EmbeddedShader& shader : embedded_shaders()) {
    if (!shader.path.ends_with(".comp.glsl")) continue;
    EXPECT_NO_THROW(Program::compute(context, shader.path)) << shader.path;
    ++count;
  }
  EXPECT_GT(count, 0);
}

TEST(Program, WhatItTakesOfTheDeviceIsKnown) {
  const ProgramResources sweep =
      resources_of(Program::compute(test::gl_context(), "carving_update_columns.comp.glsl")->id());
  EXPECT_EQ(sweep.compute.storage_blocks, 8);
  EXPECT_EQ(sweep.highest_storage_binding, 7);
  EXPECT_GT(sweep.uniform_block_bytes, 0);
  EXPECT_GT(sweep.group[0] * sweep.group[1] * sweep.group[2], 1);
  const ProgramResources bake =
      resources_of(Program::compute(test::gl_context(), "render_bake_vertices.comp.glsl")->id());
  EXPECT_EQ(bake.compute.textures, 1);
  const ProgramResources march =
      resources_of(Program::compute(test::gl_context(), "visibility_march_bricks.comp.glsl")->id());
  EXPECT_EQ(march.compute.images, 2);
}

TEST(Program, CompileErrorsNameTheShaderFile) {
  Context& context = test::gl_context();
  try {
    // Breaks the first line of code of the first file that is included.
    Program::compute(context, "visibility_splat_voxels.comp.glsl", "#define GpuView 3\n");
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("shaders/visibility_splat_voxels.comp.glsl does not compile"));
    // Mesa writes FILE:LINE, NVIDIA's driver FILE(LINE).
    EXPECT_THAT(e.what(), ContainsRegex("\nshaders/shared/view\\.h[:(]17"));
  }
}

TEST(Program, IsMadeOnceForAContext) {
  Context& context = test::gl_context();
  const auto program = Program::compute(context, "visibility_splat_voxels.comp.glsl");
  EXPECT_EQ(Program::compute(context, "visibility_splat_voxels.comp.glsl"), program);
  EXPECT_NE(Program::compute(context, "visibility_splat_voxels.comp.glsl",
                             "#define DEPTH_MAPS_LAYERED\n"),
            program);
}

TEST(Program, AnEmptyDispatchIsNoWorkAndNoError) {
  Context& context = test::gl_context();
  const auto program = Program::compute(context, "visibility_splat_voxels.comp.glsl");
  EXPECT_NO_THROW(program->dispatch(context, "empty", 0));
  EXPECT_NO_THROW(program->dispatch(context, "empty", 1, 0));
  EXPECT_EQ(context.statistics().count("empty"), 0u);
}

TEST(ProgramDeathTest, UnknownUniformsAndShadersAreProgrammerErrors) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  Context& context = test::gl_context();
  EXPECT_DEATH(Program::compute(context, "no_such.comp.glsl"), "no embedded shader no_such");
  EXPECT_DEATH(Program::compute(context, "visibility_splat_voxels.comp.glsl")->set("no_such", 1),
               "no_such");
}

TEST(GroupCount, RoundsUp) {
  EXPECT_EQ(group_count(0, 64), 0u);
  EXPECT_EQ(group_count(1, 64), 1u);
  EXPECT_EQ(group_count(64, 64), 1u);
  EXPECT_EQ(group_count(65, 64), 2u);
}

}  // namespace
}  // namespace photohull::gpu

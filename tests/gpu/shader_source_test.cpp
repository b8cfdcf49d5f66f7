#include "gpu/shader_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

namespace photohull::gpu {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

int occurrences(const std::string& text, const std::string& what) {
  int count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
    ++count;
  return count;
}

// Program::dispatch splits launches; a kernel that asked the built-in indices would not notice.
TEST(EmbeddedShaders, AskForTheirPlaceInTheWholeDispatch) {
  for (const EmbeddedShader& shader : embedded_shaders()) {
    if (shader.path == "include/dispatch.glsl") continue;
    for (const char* index : {"gl_GlobalInvocationID", "gl_WorkGroupID", "gl_NumWorkGroups"})
      EXPECT_THAT(std::string(shader.text), Not(HasSubstr(index))) << shader.path;
  }
}

TEST(ExpandShader, BeginsWithTheVersionThenTheDefines) {
  EXPECT_THAT(expand_shader("carving_score_columns.comp.glsl", "#define N 3\n"),
              StartsWith("#version 450 core\n#define N 3\n#line 1 "));
}

TEST(ExpandShader, IncludesEveryFileOnce) {
  // shared/sweep.h comes in through layer.glsl and through depth_map.glsl.
  const std::string text = expand_shader("carving_score_columns.comp.glsl", "");
  EXPECT_EQ(occurrences(text, "struct SweepParameters"), 1);
  EXPECT_EQ(occurrences(text, "struct GpuView"), 1);
  EXPECT_EQ(occurrences(text, "#version"), 1);
  EXPECT_THAT(text, Not(HasSubstr("#include")));
}

TEST(ExpandShader, IncludesWhatIsNamedInstead) {
  const auto text = [](const std::string& defines) {
    return expand_shader("carving_score_columns.comp.glsl", defines);
  };
  const std::string zncc = "include/consistency_zncc.glsl";
  const std::string census = include_instead(zncc, "include/consistency_census.glsl");
  EXPECT_THAT(text(""), Not(HasSubstr("Census")));
  EXPECT_THAT(text(census), HasSubstr("Census"));
  EXPECT_THAT(text(include_instead("include/other.glsl", zncc) + census), HasSubstr("Census"));
  EXPECT_THAT(text(include_instead("include/other.glsl", zncc)), Not(HasSubstr("Census")));
}

TEST(ExpandShader, LineDirectivesPointAtTheOriginalLines) {
  // Walks the expanded text as a compiler would; every line must be that of the file it names.
  for (const EmbeddedShader& shader : embedded_shaders()) {
    if (shader.path.find(".comp.") == std::string_view::npos) continue;
    std::istringstream text(expand_shader(shader.path, ""));
    std::string row;
    std::getline(text, row);
    int file = -1, line = 0;
    while (std::getline(text, row)) {
      if (row.starts_with("#line ")) {
        std::istringstream(row.substr(6)) >> line >> file;
        continue;
      }
      ASSERT_GE(file, 0);
      std::istringstream original{std::string(embedded_shaders()[std::size_t(file)].text)};
      std::string expected;
      for (int i = 0; i < line; ++i) std::getline(original, expected);
      if (!row.empty()) {
        EXPECT_EQ(row, expected) << shader.path << ": " << shader_file(file) << ":" << line;
      }
      ++line;
    }
  }
}

TEST(ShaderFile, NamesEmbeddedFilesOnly) {
  EXPECT_EQ(shader_file(0), embedded_shaders()[0].path);
  EXPECT_EQ(shader_file(-1), "?");
  EXPECT_EQ(shader_file(int(embedded_shaders().size())), "?");
}

}  // namespace
}  // namespace photohull::gpu

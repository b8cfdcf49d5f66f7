#include "pipeline/result_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "support/scratch_folder.h"

namespace photohull::pipeline {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::IsEmpty;

class Notes : public Progress {
 public:
  void note(const std::string& message) override { all.push_back(message); }
  std::vector<std::string> all;
};

class ResultFilesTest : public testing::Test {
 protected:
  /// What a run that writes these files notes.
  std::vector<std::string> run(const std::vector<std::string>& names) {
    ResultFiles files(folder_.path(), names);
    for (const std::string& name : names) {
      const std::string text =
          name == "report.json" ? nlohmann::json{{"files", names}}.dump() : name;
      files.open(name).write(text.data(), text.size());
    }
    Notes notes;
    files.commit(notes);
    return notes.all;
  }

  const ScratchFolder folder_;
};

TEST_F(ResultFilesTest, WhatAnEarlierRunLeftIsNoted) {
  EXPECT_THAT(run({"volume.vdb", "mesh.glb", "report.json"}), IsEmpty());
  EXPECT_THAT(run({"volume.vdb", "mesh.glb", "report.json"}), IsEmpty()) << "all are made anew";
  write_atomically(folder_ / "mine.txt", "");
  EXPECT_THAT(run({"mesh.ply", "report.json"}), ElementsAre(EndsWith(": volume.vdb, mesh.glb")));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "volume.vdb")) << "nothing is lost";
  EXPECT_THAT(run({"mesh.ply", "report.json"}), IsEmpty()) << "nobody tells of them any more";
}

TEST_F(ResultFilesTest, NothingIsKnownWithoutAnEarlierReport) {
  write_atomically(folder_ / "volume.vdb", "");
  EXPECT_THAT(run({"mesh.ply", "report.json"}), IsEmpty());
  for (const char* text : {"", "no JSON", "[1]", "{}", R"({"files": 3})", R"({"files": [3]})"}) {
    write_atomically(folder_ / "report.json", text);
    EXPECT_THAT(run({"mesh.ply", "report.json"}), IsEmpty()) << text;
  }
  write_atomically(folder_ / "report.json", R"({"files": ["gone.obj", "volume.vdb", "."]})");
  EXPECT_THAT(run({"mesh.ply", "report.json"}), ElementsAre(EndsWith(": volume.vdb")));
}

}  // namespace
}  // namespace photohull::pipeline

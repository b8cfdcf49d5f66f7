// batch, from the command line: many scenes, frames, several processes at once, and kills.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <future>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "batch_scenes.h"
#include "support/places.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;

using BatchCommand = BatchScenes;

TEST_F(BatchCommand, MakesAllScenesThoughOneFails) {
  const std::string list = list_of(1) + path("nowhere") + " --name lost\n" + "\"" + scene() +
                           "\" --name s1 --resolution 22\n";
  const Finished run = run_photohull(batch(list, "all"));
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err,
              AllOf(HasSubstr("warning: lost: "),
                    HasSubstr("photohull: 1 of 3 scenes have no result, the first is lost: ")));
  EXPECT_THAT(table("all"),
              AllOf(ContainsRegex("\ns0,[^\n]*,good,0,16,"), ContainsRegex("\nlost,[^\n]*nowhere"),
                    ContainsRegex("\ns1,[^\n]*,good,0,16,")));
  // The same as reconstruct makes.
  succeed({"reconstruct", scene(), "--out", path("alone"), "--masks", path("cutouts"), "--method",
           "hull", "--report-page", "off", "--resolution", "22"});
  EXPECT_EQ(read_bytes(folder_ / "alone/mesh.ply"), read_bytes(folder_ / "all/s1/mesh.ply"));
  EXPECT_EQ(read_bytes(folder_ / "alone/volume.vdb"), read_bytes(folder_ / "all/s1/volume.vdb"));
}

TEST_F(BatchCommand, RunAgainMakesWhatIsNotThere) {
  succeed(batch(list_of(3), "all"));
  const auto made = fs::last_write_time(folder_ / "all/s1/mesh.ply");
  const Finished again = succeed(batch(list_of(3), "all"));
  EXPECT_THAT(again.out, HasSubstr("3 scenes, 3 of them made before"));
  EXPECT_EQ(fs::last_write_time(folder_ / "all/s1/mesh.ply"), made);
  fs::remove(folder_ / "all/s1/mesh.ply");
  write_masks("cutouts", 254, 0);  // which are read as before, and are other files
  EXPECT_THAT(succeed(batch(list_of(4), "all")).out, HasSubstr("4 scenes, 0 of them made before"));
  EXPECT_TRUE(fs::is_regular_file(folder_ / "all/s1/mesh.ply"));
}

TEST_F(BatchCommand, WhatHadNoResultIsTriedAgainOnRequest) {
  write_masks("nothing", 0, 0);
  const std::string list =
      concat("\"", scene(), "\" --name s0 --masks \"", path("nothing"), "\"\n");
  const Finished run = run_photohull(batch(list, "all"));
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.out, HasSubstr("0 of them made before"));
  EXPECT_THAT(run_photohull(batch(list, "all")).out, HasSubstr("1 of them made before"));
  EXPECT_THAT(run_photohull(batch(list, "all", {"--retry"})).out,
              HasSubstr("0 of them made before"));
}

TEST_F(BatchCommand, KilledAtAnyMomentItEndsAsUndisturbed) {
  constexpr int kPieces = 4;
  int killed = 0;
  succeed(batch(list_of(kPieces), "calm"));
  for (int kill = 0; kill < 6; ++kill) {
    Arguments command = {test::program()};
    for (const std::string& word : batch(list_of(kPieces), "shaken")) command.push_back(word);
    const Finished run = run_program(command, {.signal_after = concat("s", kill % kPieces),
                                               .signal_delay_seconds = 0.13 * kill,
                                               .signal = SIGKILL,
                                               .may_end_before_signal = true});
    killed += run.signal == SIGKILL;
  }
  EXPECT_GT(killed, 0);
  succeed(batch(list_of(kPieces), "shaken"));
  EXPECT_EQ(results("shaken", kPieces), results("calm", kPieces));
}

TEST_F(BatchCommand, ProcessesShareTheWork) {
  constexpr int kPieces = 6;
  succeed(batch(list_of(kPieces), "one"));
  const Arguments arguments = batch(list_of(kPieces), "many", {"--json"});
  std::vector<std::future<Finished>> runs;
  for (int i = 0; i < 3; ++i)
    runs.push_back(std::async(std::launch::async, [&] { return run_photohull(arguments); }));
  std::map<std::string, std::set<double>> made;  // one time for each making
  for (auto& run : runs) {
    const Finished finished = run.get();
    EXPECT_EQ(finished.code, 0) << finished.err;
    std::istringstream lines(finished.out);
    for (std::string line; std::getline(lines, line);) {
      const auto told = nlohmann::json::parse(line);
      made[told.at("name")].insert(told.at("wall_seconds").get<double>());
    }
  }
  EXPECT_EQ(made.size(), std::size_t(kPieces));
  for (const auto& [name, times] : made) EXPECT_EQ(times.size(), 1u) << name << " was made twice";
  EXPECT_THAT(succeed(batch(list_of(kPieces), "many")).out, HasSubstr("6 of them made before"));
  EXPECT_EQ(results("many", kPieces), results("one", kPieces));
}

TEST_F(BatchCommand, FramesTakeTheirOwnPhotographs) {
  for (const char* frame : {"08", "09", "10"}) {
    fs::create_directories(folder_ / "frames");
    fs::create_directories(folder_ / "masks");
    fs::copy(folder_ / "images", folder_ / "frames" / frame);
    fs::copy(folder_ / "cutouts", folder_ / "masks" / frame, fs::copy_options::recursive);
  }
  write_masks("masks/09", 0, 0);  // nothing is to be seen
  const Finished run =
      run_photohull({"batch", scene(), "--frames", "08-10", "--images", path("frames/{frame}"),
                     "--masks", path("masks/{frame}"), "--method", "hull", "--resolution", "24",
                     "--report-page", "off", "--chain", "3", "--out", path("film")});
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("1 of 3 scenes have no result, the first is 09: "));
  EXPECT_THAT(read_bytes(folder_ / "film/10/report.json"), HasSubstr("\"taken_from\""))
      << "a hull starts from no surface, and its gains are the first frame's";
  for (const char* frame : {"08", "10"})
    EXPECT_EQ(read_bytes(folder_ / "film" / concat("volume.", frame, ".vdb")),
              read_bytes(folder_ / "film" / frame / "volume.vdb"));
  EXPECT_FALSE(fs::exists(folder_ / "film/volume.09.vdb"));
}

TEST_F(BatchCommand, FramesFollowEachOtherInChains) {
  const Arguments chain = {"batch",         scene(),
                           "--frames",      "1-3",
                           "--images",      path("images"),
                           "--masks",       path("cutouts"),
                           "--resolution",  "40",
                           "--report-page", "off",
                           "--chain",       "2",
                           "--out"};
  const auto with = [&](const char* command, const std::string& to) {
    Arguments all = chain;
    all[0] = command;
    all.push_back(path(to));
    return all;
  };
  const auto report = [&](const std::string& folder) {
    return nlohmann::json::parse(read_bytes(folder_ / folder / "report.json"));
  };
  succeed(with("batch", "film"));
  for (const int frame : {1, 2, 3}) {
    const nlohmann::json told = report(concat("film/", frame));
    EXPECT_EQ(told.at("followed"), frame % 2 == 0) << frame;
    EXPECT_EQ(told.at("photometric").contains("taken_from"), frame != 1) << frame;
  }
  EXPECT_THAT(succeed(with("batch", "film")).out, HasSubstr("3 of them made before"));
  // Two processes: what follows waits for what it follows, and ends the same.
  succeed(with("plan", "job"));
  EXPECT_THAT(succeed({"run", path("job"), "--pieces", "2"}).out,
              HasSubstr("1 go by others that are not made yet"));
  auto other = std::async(std::launch::async, [&] { return run_photohull({"run", path("job")}); });
  EXPECT_EQ(run_photohull({"run", path("job")}).code, 0);
  EXPECT_EQ(other.get().code, 0);
  succeed({"merge", path("job")});
  for (const char* file : {"2/mesh.ply", "3/mesh.ply"})
    EXPECT_EQ(read_bytes(folder_ / "film" / file), read_bytes(folder_ / "job" / file)) << file;
  fail(2, {"batch", scene(), "--chain", "2", "--out", out()}, {"--chain 2", "--frames"});
}

TEST_F(BatchCommand, FramesAfterOneWithoutResultAreMadeByThemselves) {
  for (const char* frame : {"1", "2", "3"}) {
    fs::create_directories(folder_ / "masks");
    fs::copy(folder_ / "cutouts", folder_ / "masks" / frame, fs::copy_options::recursive);
  }
  write_masks("masks/2", 0, 0);
  const Finished run = run_photohull({"batch", scene(), "--frames", "1-3", "--masks",
                                      path("masks/{frame}"), "--resolution", "40", "--report-page",
                                      "off", "--chain", "3", "--out", path("film")});
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("3: 2 has no result to go by"));
  const auto third = nlohmann::json::parse(read_bytes(folder_ / "film/3/report.json"));
  EXPECT_EQ(third.at("followed"), false);
  EXPECT_TRUE(third.at("photometric").contains("taken_from")) << "the first frame's";
}

TEST_F(BatchCommand, FaultsAreToldBeforeTheWork) {
  fail(2, batch("\"" + scene() + "\" --name a\n\"" + scene() + "\" --resolution 0\n", "out"),
       {"list.txt line 2", "--resolution"});
  fail(2, batch("\"" + scene() + "\" --bogus\n", "out"), {"list.txt line 1", "--bogus"});
  fail(2, batch("a\nb/a\n", "out"), {"list.txt line 1", "list.txt line 2", "called 'a'", "--name"});
  fail(2, batch("# nothing\n", "out"), {"no scene", "--list"});
  fail(1, {"batch", "--list", path("none.txt"), "--out", out()}, {"none.txt", "cannot be read"});
  fail(2, {"batch", scene(), "--frames", "9-1", "--out", out()}, {"--frames 9-1", "0-299"});
}

TEST_F(BatchCommand, StopsWhenAsked) {
  const Finished run =
      run_photohull(batch(list_of(40), "all"), {.signal_after = "s1", .signal = SIGINT});
  EXPECT_EQ(run.code, 130);
  EXPECT_THAT(table("all"), HasSubstr("\ns39,"));
  EXPECT_THAT(succeed(batch(list_of(2), "all")).out, HasSubstr("2 scenes, "));
}

}  // namespace
}  // namespace photohull::test

// The command line itself: help, info, devices, and everything that is wrong usage.
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/front/command_table.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "io/write_scene.h"
#include "sphere_scene.h"
#include "support/places.h"

namespace photohull::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

class Usage : public SphereScene {
 protected:
  /// Adds these options to a right command and expects exit code 2.
  void refuse(const Arguments& more, const std::vector<std::string>& parts) const {
    fail(2, reconstruct(more), parts);
  }
};

TEST_F(Usage, HelpShowsExamples) {
  const std::string all = succeed({"--help"}).out;
  EXPECT_THAT(all, HasSubstr("Examples:"));
  for (const cli::CommandEntry& command : cli::command_table()) {
    EXPECT_THAT(all, HasSubstr(std::string(command.description)));
    const Finished help = succeed({std::string(command.name), "--help"});
    EXPECT_THAT(help.out, HasSubstr("Examples:\n  photohull "));
    EXPECT_EQ(help.err, "");
  }
  EXPECT_THAT(succeed({"--version"}).out, StartsWith("photohull "));
}

TEST_F(Usage, SaysWhichProgramIsMissingBesideIt) {
  const std::string alone = path("photohull");
  std::filesystem::copy_file(test::program(), alone);
  EXPECT_THAT(run_program({alone, "--version"}).out, StartsWith("photohull "));
  const std::pair<const char*, const char*> programs[] = {{"info", "photohull-main"},
                                                          {"chart", "photohull-lab"}};
  for (const auto& [command, program] : programs) {
    const Finished run = run_program({alone, command, "--help"});
    EXPECT_EQ(run.code, 1);
    EXPECT_EQ(run.err, "photohull: " + path(program) +
                           ": cannot be started: No such file or directory; it belongs beside "
                           "photohull\n");
  }
}

TEST_F(Usage, ProgramsKeepFreedMemoryUnlessTheUserSaysHow) {
  const std::string alone = path("photohull"), main = path("photohull-main");
  std::filesystem::copy_file(test::program(), alone);
  std::ofstream(main) << "#!/bin/sh\nprintf %s \"$GLIBC_TUNABLES\"\n";
  std::filesystem::permissions(main, std::filesystem::perms::owner_all);
  EXPECT_THAT(run_program({alone, "info", "scene"}).out, HasSubstr("glibc.malloc.hugetlb=1"));
  RunOptions with;
  with.environment = {"GLIBC_TUNABLES=glibc.malloc.arena_max=2"};
  EXPECT_EQ(run_program({alone, "info", "scene"}, with).out, "glibc.malloc.arena_max=2");
}

TEST_F(Usage, InfoTellsWhatWasUnderstood) {
  const std::string text = succeed({"info", scene()}).out;
  for (const char* part :
       {"16 (middlebury format)", "96 x 72 pixels", "focal length   145.0", "from bbox.txt",
        "degrees to the nearest", "image scale    1\n", "MiB", "CPU seconds"})
    EXPECT_THAT(text, HasSubstr(part));
}

TEST_F(Usage, InfoAsJson) {
  const Finished run = succeed({"info", scene(), "--json", "--masks", path("cutouts")});
  EXPECT_EQ(run.err, "");
  const json info = json::parse(run.out);
  EXPECT_EQ(info["format"], "middlebury");
  ASSERT_EQ(info["views"].size(), std::size_t(kViews));
  EXPECT_EQ(info["views"][2]["name"], "view2.png");
  EXPECT_EQ(info["views"][2]["width"], kWidth);
  EXPECT_EQ(info["views"][2]["mask"], mask_file(2));
  EXPECT_NEAR(info["pixel_footprint"].get<double>(), 4.0 / 145, 1e-9);
  EXPECT_NEAR(info["normal_voxel_size"].get<double>(), 1.5 * 4.0 / 145, 1e-9);
  EXPECT_EQ(info["box"]["source"], "bbox.txt");
  EXPECT_GT(info["memory_bytes"], 0);
  EXPECT_GT(info["cpu_seconds"], 0);
}

TEST_F(Usage, InfoEstimatesTheJobThatIsAskedFor) {
  const auto estimate = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"info", scene(), "--json"});
    return json::parse(succeed(options).out);
  };
  const json coarse = estimate({"--resolution", "64"}), fine = estimate({"--resolution", "512"});
  EXPECT_GT(fine["memory_bytes"], coarse["memory_bytes"]);
  EXPECT_GT(fine["cpu_seconds"], coarse["cpu_seconds"]);
  EXPECT_EQ(coarse["image_scale"], 1);
  EXPECT_EQ(estimate({"--image-scale", "1/4"})["image_scale"], 0.25);
  // Without masks rays search the box.
  const json open = estimate({"--resolution", "512", "--masks", "none"});
  EXPECT_GT(open["cpu_seconds"], fine["cpu_seconds"]);
  EXPECT_LT(estimate({"--resolution", "512", "--method", "hull"})["cpu_seconds"],
            fine["cpu_seconds"]);
  // Of the views that will be used.
  EXPECT_LT(estimate({"--resolution", "512", "--views", "spread:4"})["cpu_seconds"],
            fine["cpu_seconds"]);
  EXPECT_LT(estimate({"--resolution", "512", "--views", "spread:4"})["memory_bytes"],
            fine["memory_bytes"]);
  EXPECT_THAT(succeed({"info", scene(), "--max-memory", "1M"}).out,
              HasSubstr("would take more memory than it may (1 MiB; --max-memory)"));
}

TEST_F(Usage, InfoTellsWhatItKnowsWhereTheBoxCannotBeUsed) {
  // Points of the sphere, and a few of its surroundings.
  for (int i = 0; i < 400; ++i) {
    const double z = (i + 0.5) / 200 - 1, turn = 2.4 * i, r = std::sqrt(1 - z * z);
    scene_.points.push_back(kCentre +
                            kRadius * glm::dvec3(r * std::cos(turn), r * std::sin(turn), z));
  }
  for (int i = 0; i < 4; ++i) scene_.points.push_back(kCentre + glm::dvec3(30 + i, 5 * i, -20));
  scene_.box.reset();
  io::write_scene(scene_, SceneFormat::kColmapText, path("colmap"));
  // Nothing of it is in any picture.
  const Arguments arguments = {"info", path("colmap"), "--box", "0 0 100 1 1 101"};
  const Finished run = run_photohull(arguments);
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("no camera has the box from --box on its image"));
  for (const char* part :
       {"views          16", "box            (0 0 100) to (1 1 101)", "cameras at ",
        "sparse points  404", "   0 to 100 %", "  25 to  75 %", "suggestion     --box \""})
    EXPECT_THAT(run.out, HasSubstr(part));
  Arguments as_json = arguments;
  as_json.push_back("--json");
  const json info = json::parse(run_photohull(as_json).out);
  EXPECT_THAT(std::string(info["failure"]), HasSubstr("no camera has the box"));
  EXPECT_EQ(info["points"]["count"], 404);
  EXPECT_GT(info["points"]["extents"][0]["max"][0], 30);
  EXPECT_FALSE(info.contains("memory_bytes"));
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(info["points"]["extents"][2]["max"][axis], kCentre[axis] + 0.9 * kRadius, 0.1);
    const double low = info["suggested_box"]["min"][axis],
                 high = info["suggested_box"]["max"][axis];
    EXPECT_LT(low, kCentre[axis] - kRadius);
    EXPECT_GT(high, kCentre[axis] + kRadius);
    EXPECT_LT(high - low, 3 * kRadius);
  }
  // Without points, the cameras tell where they look.
  const json bare =
      json::parse(run_photohull({"info", scene(), "--box", "0 0 100 1 1 101", "--json"}).out);
  EXPECT_EQ(bare["points"]["count"], 0);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(
        (double(bare["suggested_box"]["min"][axis]) + double(bare["suggested_box"]["max"][axis])) /
            2,
        kCentre[axis], 0.05);
  // What serves says nothing of this.
  EXPECT_FALSE(json::parse(succeed({"info", scene(), "--json"}).out).contains("suggested_box"));
}

TEST_F(Usage, SwappedCornersOfTheBoxAreSortedAndTold) {
  const Finished run = succeed({"info", scene(), "--box", "0.9 -1 -0.5 -0.7 0.6 1.1"});
  EXPECT_THAT(run.out, HasSubstr("box            (-0.7 -1 -0.5) to (0.9 0.6 1.1), from --box"));
  EXPECT_THAT(run.out, HasSubstr("warning: the corners of --box are swapped along x"));
}

TEST_F(Usage, PhotographsElsewhereServeEveryCommand) {
  std::filesystem::rename(folder_ / "images", folder_ / "elsewhere");
  fail(1, {"info", scene()}, {"not found", "--images"});
  const std::string there = path("elsewhere");
  succeed({"info", scene(), "--images", there});
  succeed({"convert", scene(), "--images", there, "--to", "transforms", "--out", path("t")});
  succeed({"masks", scene(), "--images", there, "--out", path("m")});
  succeed(reconstruct({"--images", there, "--method", "hull"}));
  succeed(
      {"evaluate", out() + "/mesh.ply", "--photos", scene(), "--images", there, "--views", "0"});
  EXPECT_EQ(io::load_scene(folder_ / "t").views[0].image.parent_path(), folder_ / "elsewhere");
}

TEST_F(Usage, InfoFindsABoxThatTheSceneDoesNotGive) {
  std::filesystem::remove(folder_ / "bbox.txt");
  EXPECT_THAT(succeed({"info", scene()}).out, HasSubstr("found: "));
  const json box = json::parse(succeed({"info", scene(), "--json"}).out)["box"];
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LT(box["min"][axis].get<double>(), kCentre[axis] - 0.9 * kRadius);
    EXPECT_GT(box["max"][axis].get<double>(), kCentre[axis] + 0.9 * kRadius);
    EXPECT_LT(box["max"][axis].get<double>() - box["min"][axis].get<double>(), 3 * kRadius);
  }
}

TEST_F(Usage, ReconstructionFindsABoxAndSaysSo) {
  std::filesystem::remove(folder_ / "bbox.txt");
  succeed(reconstruct({"--quality", "draft"}));
  const json report = json::parse(read_bytes(out() + "/report.json"));
  EXPECT_THAT(report["box"]["source"], HasSubstr("found: the space that the silhouettes of 16"));
}

TEST_F(Usage, PlainPicturesTellNoBox) {
  std::filesystem::remove(folder_ / "bbox.txt");
  const std::vector<std::uint8_t> grey(std::size_t(kWidth) * kHeight * 3, 100);
  for (int view = 0; view < kViews; ++view) io::write_png(image(view), kWidth, kHeight, 3, grey);
  const Finished run = succeed({"info", scene()});  // the rest is told all the same
  EXPECT_THAT(run.out, HasSubstr("views          16"));
  EXPECT_THAT(run.out, HasSubstr("warning: " + scene() + ": no box can be found: 0 features"));
  EXPECT_FALSE(json::parse(succeed({"info", scene(), "--json"}).out).contains("box"));
  fail(1, reconstruct({"--masks", "none"}), {"no box can be found", "give --box"});
  fail(1, {"info", scene(), "--picture", path("box.png")}, {"--picture", "no box to draw"});
}

TEST_F(Usage, BoxesThatAreOutOfRange) {
  for (const char* bad : {"0", "-1", "nan", "0.01", "1000"})
    refuse({"--box-scale", bad}, {"--box-scale", "a factor from 0.05 to 20"});
  refuse({"--box", "automatic"}, {"--box", "expected auto or six numbers"});
  const Finished info = run_photohull({"info", scene(), "--box", "0 0 40 1 1 41"});
  EXPECT_EQ(info.code, 1);
  EXPECT_THAT(info.err, HasSubstr("no camera has the box from --box"));
  EXPECT_THAT(info.out, HasSubstr("suggestion"));
}

TEST_F(Usage, InfoDrawsTheBox) {
  succeed({"info", scene(), "--box-scale", "0.9", "--picture", path("box.png")});
  const ColourImage picture = io::read_image(path("box.png"));
  EXPECT_GT(picture.width, 1000);
  EXPECT_GT(picture.height, 1000);
  fail(2, {"info", scene(), "--picture", ""}, {"--picture is empty"});
  succeed({"info", scene(), "--picture", path("new/folder/box.png")});
  EXPECT_EQ(io::read_image(path("new/folder/box.png")).width, picture.width);
  fail(1, {"info", scene(), "--picture", path("bbox.txt/box.png")},
       {"bbox.txt: the folder cannot be made", "choose another with --picture"});
}

TEST_F(Usage, DevicesSaysWhatAutoTakes) {
  const std::string text = succeed({"devices"}).out;
  EXPECT_THAT(text, StartsWith("0  "));
  EXPECT_THAT(text, HasSubstr("auto takes "));
}

TEST_F(Usage, DeviceByName) {
  succeed(reconstruct({"--device", "software", "--quality", "draft"}));
  refuse({"--device", "99"}, {"--device 99", "photohull devices"});
  for (const char* bad : {"gpu", "-1", "", "1x"}) refuse({"--device", bad}, {"--device"});
}

TEST_F(Usage, ParserErrorsAreOneLine) {
  fail(2, {}, {"a command is missing", "--help"});
  fail(2, {"rebuild"}, {"rebuild"});
  fail(2, {"reconstruct"}, {"required"});
  fail(2, {"reconstruct", scene()}, {"--out is required"});
  fail(2, {"info"}, {"SCENE is required"});
  fail(2, {"info", scene(), "--out", out()}, {"--out"});
  refuse({"--resolutoin", "32"}, {"--resolutoin"});
  refuse({"surplus"}, {"surplus"});
  refuse({"--resolution"}, {"--resolution"});
}

TEST_F(Usage, NamesThatMayHaveBeenMeant) {
  fail(2, {"recosntruct", scene()}, {"no command recosntruct", "did you mean reconstruct?"});
  fail(2, {"bench", "sampleing"}, {"no command sampleing", "did you mean sampling?"});
  fail(2, {"--versoin"}, {"no option --versoin", "did you mean --version?"});
  refuse({"--resolutoin", "32"},
         {"no option --resolutoin of photohull reconstruct", "did you mean --resolution?"});
  refuse({"--qualty=high"}, {"no option --qualty", "did you mean --quality?"});
  // What is missing may be misspelt.
  fail(2, {"reconstruct", scene(), "--outt", out()}, {"no option --outt", "did you mean --out?"});
  refuse({"--enigma", "32"}, {"no option --enigma", "see --help"});
}

TEST_F(Usage, VersionAsJson) {
  const json version = json::parse(succeed({"--version", "--json"}).out);
  EXPECT_THAT(succeed({"--version"}).out,
              "photohull " + version["version"].get<std::string>() + "\n");
  EXPECT_FALSE(version["commit"].get<std::string>().empty());
  for (const char* library : {"OpenVDB", "OpenCV", "Ceres", "OpenImageIO", "embree", "TBB"})
    EXPECT_THAT(version["libraries"][library].get<std::string>(), testing::ContainsRegex("^[0-9]"))
        << library;
  EXPECT_FALSE(version["device"]["renderer"].get<std::string>().empty());
  fail(2, {"--json"}, {"a command is missing"});
  fail(2, {"--json", "devices"}, {"--json stands behind the command"});
}

TEST_F(Usage, PlansAreCheckedBeforeTheFirstRun) {
  write_bytes(path("gt.ply"), "");
  const std::string head = R"({"scenes": [{"path": ".", "name": "ball"}], "resolutions": [16], )";
  const auto refuse_plan = [&](const std::string& rest, const std::vector<std::string>& parts) {
    write_bytes(path("plan.json"), head + rest + "}");
    fail(1, {"chart", path("plan.json"), "--out", out()}, parts);
    EXPECT_FALSE(std::filesystem::exists(out()));
  };
  refuse_plan(R"("methods": ["hull", "magic"])", {"plan.json", "ball: magic 16", "--method magic"});
  refuse_plan(R"("methods": ["hull"], "arguments": ["--qualty", "draft"])",
              {"plan.json", "ball: hull 16", "no option --qualty", "did you mean --quality?"});
  refuse_plan(R"("methods": ["hull"], "arguments": ["--sampler", "ewa"])", {"--sampler"});
  refuse_plan(R"("variants": [{"name": "both", "arguments": ["--voxel-size", "1"]}])",
              {"ball: both 16", "exclude each other"});
  write_bytes(path("stress.json"), R"({"scenes": [{"name": "ball", "spec": {}}],
      "arguments": ["--metod", "hull"],
      "axes": [{"name": "noise", "fields": ["degradations.read_noise"], "strengths": [0.1]}]})");
  fail(1, {"stress", path("stress.json"), "--out", out()}, {"stress.json", "--metod"});
}

TEST_F(Usage, FixedLatticesNeedWhatDoesNotFollowThePhotographs) {
  refuse({"--lattice", "loose"}, {"--lattice loose", "fit, fixed"});
  fail(2, {"reconstruct", scene(), "--out", out(), "--lattice", "fixed"},
       {"--lattice fixed", "--voxel-size or --resolution"});
  refuse({"--lattice", "fixed", "--box", "auto"}, {"--lattice fixed", "--box auto"});
  std::filesystem::remove(folder_ / "bbox.txt");
  fail(1, reconstruct({"--lattice", "fixed"}), {"--lattice fixed", "give --box"});
}

TEST_F(Usage, NumbersOutOfRange) {
  for (const char* bad : {"1", "0", "-5"})
    refuse({"--resolution", bad}, {"--resolution " + std::string(bad), "at least 2"});
  for (const char* bad : {"many", "3.5", "99999999999"})
    refuse({"--resolution", bad}, {"--resolution"});
  for (const char* bad : {"0", "-1", "nan", "inf"})
    refuse({"--voxel-size", bad}, {"--voxel-size", "finite and positive"});
  refuse({"--voxel-size", "100"}, {"--voxel-size 100", "at most 1"});
  refuse({"--resolution", "32", "--voxel-size", "0.1"}, {"exclude each other"});
  refuse({"--threads", "-1"}, {"--threads -1"});
  for (const char* bad : {"0.3", "-1", "nan"}) refuse({"--pixel-center", bad}, {"--pixel-center"});
}

TEST_F(Usage, ViewsThatMayMiss) {
  for (const char* bad : {"-1", "17", "some", "", "1.5", "2 ", "99999999999"})
    refuse({"--views-may-miss", bad}, {"--views-may-miss " + std::string(bad),
                                       "expected auto, or a number of views from 0 to 16"});
}

TEST_F(Usage, WordsThatAreNotChoices) {
  refuse({"--quality", "best"}, {"--quality best", "draft, normal, high"});
  refuse({"--method", "magic"}, {"--method magic", "hull, voxel-coloring, space-carving"});
  refuse({"--method", ""}, {"--method"});
  refuse({"--format", "obj"}, {"--format obj", "middlebury"});
  refuse({"--masks", ""}, {"--masks"});
  fail(2, {"reconstruct", scene(), "--out", ""}, {"--out"});
  fail(2, {"reconstruct", "", "--out", out()}, {"SCENE"});
}

TEST_F(Usage, OptionsOfTheSweeps) {
  refuse({"--method", "space-carving", "--sampler", "bicubic"},
         {"--sampler bicubic", "trilinear", "ewa"});
  refuse({"--method", "space-carving", "--consistency", "ssd"},
         {"--consistency ssd", "zncc", "census"});
  for (const char* bad : {"0", "9", "-1"})
    refuse({"--method", "space-carving", "--supersample", bad},
           {"--supersample " + std::string(bad), "1 to 8"});
  refuse({"--sampler", "ewa"}, {"--sampler", "--method refine", "space-carving"});
  refuse({"--method", "hull", "--consistency", "census"}, {"--consistency", "--method hull"});
}

TEST_F(Usage, BenchNamesWhatItMeasures) {
  fail(2, {"bench"}, {"subcommand is required", "--help"});
  fail(2, {"bench", "sampling", "--squares", "3"}, {"--squares 3", "16 to 100000"});
  fail(2, {"bench", "sampling", "--device", "99"}, {"--device 99"});
  fail(2, {"bench", "visibility", "--scenes", "moon"}, {"--scenes moon"});
  fail(2, {"bench", "visibility", "--resolutions", "8"}, {"--resolutions 8", "16 to 8192"});
  fail(2, {"bench", "visibility", "--techniques", "sun"},
       {"--techniques sun", "plain, slope-bias"});
  EXPECT_THAT(succeed({"bench", "sampling", "--help"}).out,
              HasSubstr("Examples:\n  photohull bench"));
}

TEST_F(Usage, Boxes) {
  for (const char* bad : {"0 0 0 1 1", "0 0 0 1 1 x", "nan 0 0 1 1 1", "", "0 0 0 1 1 1e999"})
    refuse({"--box", bad}, {"--box", "six numbers"});
  refuse({"--box", "0 0 0 1 1 1 1"}, {"--box", "follows the six numbers"});
  refuse({"--box", "0 0 0 1 1 1x"}, {"--box"});
  refuse({"--box", "0 0 0 1 0 1"}, {"--box", "along y"});
}

TEST_F(Usage, Views) {
  refuse({"--views", "nobody.png"}, {"--views", "'nobody.png'"});
  refuse({"--views", "0-99"}, {"--views", "views 0 to 15"});
  refuse({"--views", "5-2"}, {"--views", "backwards"});
  refuse({"--views", "1,,2"}, {"--views", "empty item"});
  refuse({"--views", ""}, {"--views"});
}

TEST_F(Usage, AClosedPipeEndsQuietly) {
  const auto pipe = [&](const std::string& command) {
    return run_program({"bash", "-c",
                        "(sleep 1; " + test::program() + " " + command +
                            "; echo \"code $?\" >&2) | true; sleep 2"});
  };
  EXPECT_EQ(pipe("info " + scene()).err, "code 0\n");
  EXPECT_EQ(pipe("reconstruct --help").err, "code 0\n");
}

TEST_F(Usage, AFullStandardOutputIsAFailure) {
  RunOptions full;
  full.output_file = "/dev/full";
  fail(1, {"info", scene()}, {"standard output"}, full);
  fail(1, {"reconstruct", "--help"}, {"standard output"}, full);
}

}  // namespace
}  // namespace photohull::test

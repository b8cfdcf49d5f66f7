// The report's page: written, left out, and opened.
#include <filesystem>

#include "reconstruct_fixture.h"
#include "support/places.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class View : public Reconstruct {
 protected:
  Arguments quick(const Arguments& more = {}) const {
    Arguments all = {"--method", "hull"};
    all.insert(all.end(), more.begin(), more.end());
    return reconstruct(all);
  }

  /// A desktop whose opener notes what it is to open and ends with that code.
  RunOptions desktop(const std::string& code) const {
    const fs::path program = fs::path(path("bin")) / "xdg-open";
    fs::create_directories(program.parent_path());
    write_bytes(program,
                "#!/bin/sh\nprintf %s \"$1\" > '" + path("opened") + "'\nexit " + code + "\n");
    fs::permissions(program, fs::perms::owner_all);
    RunOptions options;
    options.environment = {"DISPLAY=:7", "PATH=" + path("bin") + ":/usr/bin:/bin"};
    return options;
  }
  RunOptions no_desktop() const {
    RunOptions options;
    options.environment = {"DISPLAY=", "WAYLAND_DISPLAY="};
    return options;
  }
};

TEST_F(View, PrintsWhereThePageIsWithoutADisplay) {
  succeed(quick());
  for (const std::string& given : {out(), path("out/report.html")})
    EXPECT_EQ(succeed({"view", given}, no_desktop()).out, path("out/report.html") + "\n");
}

TEST_F(View, OpensThePageOnADesktop) {
  succeed(quick());
  succeed({"view", out()}, desktop("0"));
  EXPECT_EQ(read_bytes(path("opened")), path("out/report.html"));
}

TEST_F(View, SaysWhatIsMissing) {
  succeed(quick({"--report-page", "off"}));
  const auto refuse = [&](int code, const Arguments& arguments,
                          const std::vector<std::string>& parts) {
    const Finished run = run_program(
        [&] {
          Arguments all = {test::program()};
          all.insert(all.end(), arguments.begin(), arguments.end());
          return all;
        }(),
        no_desktop());
    EXPECT_EQ(run.code, code) << run.err;
    for (const std::string& part : parts) EXPECT_THAT(run.err, HasSubstr(part));
  };
  refuse(1, {"view", out()}, {"has no report.html", "--report-page off"});
  refuse(1, {"view", path("nowhere")}, {path("nowhere"), "no such folder"});
  refuse(1, {"view", path("out/mesh.ply")}, {"this is a file"});
  refuse(2, {"view"}, {"DIR"});
  refuse(2, {"view", ""}, {"DIR is empty"});
}

TEST_F(View, SaysThatTheDesktopDidNotOpenIt) {
  succeed(quick());
  RunOptions options = desktop("3");
  const Finished run = run_program({test::program(), "view", out()}, options);
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("open it in a browser"));
  EXPECT_THAT(run.out, HasSubstr(path("out/report.html")));
}

TEST_F(View, LeavesThePageOut) {
  const Finished run = succeed(quick({"--report-page", "off"}));
  EXPECT_THAT(listing(out()), Not(Contains("report.html")));
  EXPECT_THAT(run.out, Not(HasSubstr("report.html")));
  EXPECT_EQ(report()["options"]["report_page"], "off");
}

TEST_F(View, PageHasTheReportThatIsBesideIt) {
  succeed(quick());
  const std::string page = read_bytes(path("out/report.html"));
  const std::size_t start = page.find('>', page.find("id=\"data\"")) + 1;
  const auto data =
      nlohmann::json::parse(page.substr(start, page.find("</script>", start) - start));
  nlohmann::json expected = report();
  expected.erase("inputs");
  expected.erase("device_work");
  expected.erase("cameras");
  EXPECT_EQ(data["report"], expected);
  EXPECT_EQ(data["views"].size(), std::size_t(kViews));
  EXPECT_EQ(data["model"]["triangles"], expected["mesh"]["triangles"]);
  EXPECT_THAT(data["command"].get<std::string>(),
              HasSubstr("photohull reconstruct " + scene() + " --out " + out() +
                        " --method hull --resolution 32 --masks "));
}

/// But for what took time and memory.
TEST_F(View, PagesOfTwoRunsShowTheSame) {
  const auto shown = [&] {
    succeed(quick());
    const std::string page = read_bytes(path("out/report.html"));
    const std::size_t start = page.find('>', page.find("id=\"packed-model\""));
    return page.substr(start);
  };
  const std::string first = shown();
  EXPECT_EQ(shown(), first);
}

}  // namespace
}  // namespace photohull::test

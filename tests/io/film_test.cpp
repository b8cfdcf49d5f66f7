// Films by ffmpeg, and pictures in files of their own. What stands for ffmpeg here is a script, but
// in the tests that skip where there is none.
#include "io/film.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "core/error.h"
#include "io/image_file.h"
#include "support/scratch_folder.h"

namespace photohull::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

constexpr FilmFormat kFormat{32, 24, 5, 10};

RgbImage picture(int shade) {
  return {32, 24, std::vector<std::uint8_t>(32 * 24 * 3, std::uint8_t(shade))};
}

std::string bytes_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

class FilmTest : public testing::Test {
 protected:
  FilmTest() : path_(std::getenv("PATH") ? std::getenv("PATH") : "") {}
  ~FilmTest() override { ::setenv("PATH", path_.c_str(), 1); }

  /// From now on `ffmpeg` is this script of a shell.
  void set_ffmpeg(const std::string& script) {
    const fs::path program = folder_ / "bin/ffmpeg";
    fs::create_directories(program.parent_path());
    std::ofstream(program) << "#!/bin/sh\n" << script << "\n";
    fs::permissions(program, fs::perms::owner_all);
    ::setenv("PATH", (program.parent_path().string() + ":/usr/bin:/bin").c_str(), 1);
  }
  std::string name(const std::string& file) const { return (folder_ / file).string(); }
  std::vector<std::string> files(const std::string& in = "") const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ / in))
      if (entry.path().filename() != "bin") names.push_back(entry.path().filename().string());
    return names;
  }
  void make(const std::string& file) {
    const auto film = open_film(name(file), kFormat, progress_);
    for (int i = 0; i < 5; ++i) film->add(picture(40 * i));
    film->finish();
  }
  std::string failure(const std::string& file) {
    try {
      make(file);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  ScratchFolder folder_;
  std::string path_;
  Progress progress_;
};

TEST_F(FilmTest, PicturesAreNumberedFilesOfPng) {
  make("p%02d.png");
  EXPECT_THAT(files(), UnorderedElementsAre("p00.png", "p01.png", "p02.png", "p03.png", "p04.png"));
  const ColourImage last = read_image(folder_ / "p04.png");
  EXPECT_EQ(last.width, 32);
  EXPECT_EQ(int(last.bytes[0]), 160);
  make("frames");
  EXPECT_THAT(files("frames"),
              UnorderedElementsAre("frame_0000.png", "frame_0001.png", "frame_0002.png",
                                   "frame_0003.png", "frame_0004.png"));
}

TEST_F(FilmTest, WhatIsNotFinishedLeavesNothing) {
  for (const char* file : {"p%02d.png", "frames"}) {
    const auto film = open_film(name(file), kFormat, progress_);
    film->add(picture(1));
  }
  set_ffmpeg("exec cat > /dev/null");
  std::ofstream(name("old.mp4")) << "an older film";
  open_film(name("old.mp4"), kFormat, progress_)->add(picture(1));
  EXPECT_THAT(files(), UnorderedElementsAre("old.mp4"));
  EXPECT_EQ(bytes_of(name("old.mp4")), "an older film");
}

TEST_F(FilmTest, CtrlCEndsItAndItsFileGoes) {
  set_ffmpeg("exec sleep 60");  // and takes no pictures
  const CancellationToken token;
  const Progress progress(token);
  const auto film = open_film(name("film.mp4"), {640, 480, 5, 10}, progress);
  token.cancel();
  const RgbImage large{640, 480, std::vector<std::uint8_t>(640 * 480 * 3)};
  EXPECT_THROW(film->add(large), Cancelled);
}

TEST_F(FilmTest, NamesThatSayNoFormatAreRefused) {
  for (const char* file : {"film.avi", "p%s.png", "p%d%d.png", "p.png", "p%02d.jpg"})
    EXPECT_THROW(open_film(name(file), kFormat, progress_), UsageError) << file;
  EXPECT_THROW(open_film("", kFormat, progress_), UsageError);
  EXPECT_THROW(open_film(name("film.mp4"), {33, 24, 5, 10}, progress_), UsageError);
  EXPECT_TRUE(files().empty());
}

TEST_F(FilmTest, SaysThatFfmpegIsNotInstalled) {
  ::setenv("PATH", "/nowhere", 1);
  EXPECT_THAT(failure("film.mp4"), HasSubstr("install the package ffmpeg"));
  EXPECT_TRUE(files().empty());
}

TEST_F(FilmTest, TellsWhatFfmpegSaysWhereItFails) {
  set_ffmpeg("cat > /dev/null; echo 'pipe: No space left on device' >&2; exit 1");
  EXPECT_THAT(failure("film.mp4"),
              testing::AllOf(HasSubstr("film.mp4"), HasSubstr("No space left on device")));
  set_ffmpeg("exit 7");
  EXPECT_THAT(failure("film.mp4"), HasSubstr("its exit code is 7"));
  set_ffmpeg("kill -9 $$");
  EXPECT_THAT(failure("film.mp4"), HasSubstr("signal 9 ended it"));
  EXPECT_TRUE(files().empty());
}

TEST_F(FilmTest, AProgramThatEndsEarlyIsAnErrorAndNoSignal) {
  set_ffmpeg("exit 7");
  const auto film = open_film(name("film.mp4"), {640, 480, 20, 10}, progress_);
  const RgbImage large{640, 480, std::vector<std::uint8_t>(640 * 480 * 3)};
  EXPECT_THROW(for (int i = 0; i < 20; ++i) film->add(large), Error);
}

TEST_F(FilmTest, OfRealFfmpegAreTheSameEveryTime) {
  if (std::system("ffmpeg -version > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "ffmpeg is not installed";
  const std::vector<std::string> beginnings = {"ftyp",     "ftyp", "\x1a\x45",
                                               "\x1a\x45", "GIF8", "RIFF"};
  std::size_t k = 0;
  for (const char* extension : {"mp4", "mov", "mkv", "webm", "gif", "webp"}) {
    const std::string one = concat("one.", extension), other = concat("other.", extension);
    make(one);
    make(other);
    const std::string bytes = bytes_of(name(one));
    EXPECT_EQ(bytes, bytes_of(name(other))) << extension;
    EXPECT_NE(bytes.substr(0, 16).find(beginnings[k++]), std::string::npos) << extension;
  }
}

}  // namespace
}  // namespace photohull::io

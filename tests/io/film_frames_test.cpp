// Pictures out of films, by ffmpeg itself; these tests skip where there is none.
#include "io/film_frames.h"

#include <cstdlib>

#include "core/child_process.h"
#include "io/film.h"
#include "io/image_file.h"
#include "scene_fixture.h"

namespace photohull::io {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class FilmFrames : public TemporaryFolder {
 protected:
  std::vector<std::vector<fs::path>> extract(const std::string& name, int frames) const {
    FrameOptions options;
    options.frames = frames;
    return extract_stretches(folder_ / name, folder_ / "100% frames", options, progress_);
  }
  /// 40 pictures, of which each is lighter than the one before.
  void make_film(const std::string& name) const {
    const auto film = open_film((folder_ / name).string(), {64, 48, 40, 20}, progress_);
    for (int i = 0; i < 40; ++i)
      film->add({64, 48, std::vector<std::uint8_t>(64 * 48 * 3, std::uint8_t(20 + 5 * i))});
    film->finish();
  }
  Progress progress_;
};

TEST_F(FilmFrames, StretchesHaveUpToSixPicturesInTheFilmsOrder) {
  if (!is_on_path("ffmpeg") || !is_on_path("ffprobe")) GTEST_SKIP() << "ffmpeg is not installed";
  make_film("a film.mp4");
  const auto stretches = extract("a film.mp4", 5);
  ASSERT_EQ(stretches.size(), 5u);
  int last = 0;
  for (const auto& stretch : stretches) {
    EXPECT_GE(stretch.size(), 5u);
    EXPECT_LE(stretch.size(), 6u);
    for (const fs::path& picture : stretch) {
      const ColourImage image = read_image(picture);
      EXPECT_EQ(image.width, 64);
      EXPECT_GT(int(image.bytes[0]), last);
      last = int(image.bytes[0]);
    }
  }
}

TEST_F(FilmFrames, AShortFilmGivesAllItsPictures) {
  if (!is_on_path("ffmpeg") || !is_on_path("ffprobe")) GTEST_SKIP() << "ffmpeg is not installed";
  make_film("short.mkv");
  const auto stretches = extract("short.mkv", 100);
  EXPECT_NEAR(double(stretches.size()), 40, 1);
  for (const auto& stretch : stretches) EXPECT_EQ(stretch.size(), 1u);
}

TEST_F(FilmFrames, FilmsThatCannotBeReadAreNamed) {
  EXPECT_THAT(error_of([&] { extract("none.mp4", 5); }),
              AllOf(HasSubstr("none.mp4"), HasSubstr("there is no such film")));
  EXPECT_THAT(error_of([&] { extract("none.mp4", 1); }), HasSubstr("frames"));
  put("torn.mp4", "no film");
  if (is_on_path("ffmpeg") && is_on_path("ffprobe")) {
    EXPECT_THAT(error_of([&] { extract("torn.mp4", 5); }),
                AllOf(HasSubstr("torn.mp4: the film cannot be read"), HasSubstr("MP4")));
    put_image("still.png");
    EXPECT_THAT(error_of([&] { extract("still.png", 5); }), HasSubstr("still.png"));
  }
  const std::string path = std::getenv("PATH") ? std::getenv("PATH") : "";
  ::setenv("PATH", (folder_ / "nowhere").c_str(), 1);
  EXPECT_THAT(error_of([&] { extract("torn.mp4", 5); }), HasSubstr("which is not installed"));
  ::setenv("PATH", path.c_str(), 1);
}

}  // namespace
}  // namespace photohull::io

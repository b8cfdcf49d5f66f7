#include "io/photo_lens.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "scene_fixture.h"

namespace photohull::io {
namespace {

using PhotoLensTest = TemporaryFolder;

std::filesystem::path photograph(const std::filesystem::path& file, float seconds, float stop,
                                 int speed) {
  OIIO::ImageSpec spec(36, 24, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("Make", "Maker");
  spec.attribute("ExposureTime", seconds);
  spec.attribute("FNumber", stop);
  if (speed > 0) spec.attribute("Exif:PhotographicSensitivity", speed);
  const std::vector<unsigned char> grey(std::size_t(36) * 24 * 3, 90);
  const auto out = OIIO::ImageOutput::create(file.string());
  EXPECT_TRUE(out && out->open(file.string(), spec) &&
              out->write_image(OIIO::TypeDesc::UINT8, grey.data()) && out->close());
  return file;
}

TEST_F(PhotoLensTest, TellsTheExposureThatTheCameraChose) {
  const double once = read_photo_lens(photograph(folder_ / "a.jpg", 0.01f, 4, 200)).exposure;
  EXPECT_NEAR(once, 0.01 / 16 * 2, 1e-6);
  // A stop more light by another aperture.
  EXPECT_NEAR(read_photo_lens(photograph(folder_ / "b.jpg", 0.01f, 2.8284f, 200)).exposure,
              2 * once, 1e-5);
  EXPECT_EQ(read_photo_lens(photograph(folder_ / "c.jpg", 0.01f, 4, 0)).exposure, 0);
  EXPECT_EQ(read_photo_lens(put_image("d.png")).exposure, 0);
}

/// As the command line reads it.
FocalOptions focal_of(const std::string& text) {
  FocalOptions options;
  Described described;
  describe(described, options);
  read_option(*described.find("focal"), text);
  return options;
}

TEST_F(PhotoLensTest, AGivenFocalLengthIsForFilesThatStateNone) {
  const auto file = photograph(folder_ / "a.jpg", 0, 0, 0);  // 36 x 24 pixels
  EXPECT_EQ(read_photo_lens(file).focal, 0);
  EXPECT_EQ(read_photo_lens(file, focal_of("40")).focal, 40);
  const PhotoLens film = read_photo_lens(file, focal_of("28mm"));
  EXPECT_NEAR(film.focal, 28, 1e-9);  // a pixel is a millimetre of film
  EXPECT_TRUE(film.given);
  OIIO::ImageSpec spec(36, 24, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("Exif:FocalLengthIn35mmFilm", 50);
  const std::vector<unsigned char> grey(std::size_t(36) * 24 * 3, 90);
  const auto out = OIIO::ImageOutput::create("b.jpg");
  ASSERT_TRUE(out && out->open((folder_ / "b.jpg").string(), spec) &&
              out->write_image(OIIO::TypeDesc::UINT8, grey.data()) && out->close());
  const PhotoLens stated = read_photo_lens(folder_ / "b.jpg", focal_of("28 mm"));
  EXPECT_NEAR(stated.focal, 50, 1e-4);
  EXPECT_FALSE(stated.given);
}

TEST_F(PhotoLensTest, FocalLengthsOfNoCameraAreRefused) {
  for (const char* text : {"0", "-3", "28cm", "mm", "", "nan", "inf", "3mm", "9000mm", "28 mm x"})
    EXPECT_THROW(focal_of(text), UsageError) << text;
  const auto file = photograph(folder_ / "a.jpg", 0, 0, 0);
  EXPECT_THROW(read_photo_lens(file, focal_of("5000")), UsageError);
  try {
    read_photo_lens(file, focal_of("4"));
    FAIL();
  } catch (const UsageError& e) {
    EXPECT_EQ(
        std::string(e.what()),
        "focal=4: in a.jpg, of 36 x 24 pixels, it is a field of view of 159.05 degrees across "
        "the diagonal; give it between 5 and 4326 pixels of that photograph, or for 35 mm "
        "film, such as 28mm");
  }
}

}  // namespace
}  // namespace photohull::io

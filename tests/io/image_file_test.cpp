#include "io/image_file.h"

#include <OpenImageIO/half.h>
#include <OpenImageIO/imageio.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <thread>

#include "scene_fixture.h"

// OpenImageIO's PNG reader leaves a damaged file by longjmp over a string of its own (2.4); only
// programs built with the leak sanitizer call this.
extern "C" const char* __lsan_default_suppressions() { return "leak:ImageInput::geterror"; }

namespace photohull::io {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;

using ImageFile = TemporaryFolder;

/// Writes values as they are stored, without any conversion of OpenImageIO's.
template <typename T>
void write_raw(const fs::path& path, OIIO::ImageSpec spec, const std::vector<T>& values) {
  spec.attribute("oiio:UnassociatedAlpha", 1);
  auto out = OIIO::ImageOutput::create(path.string());
  ASSERT_TRUE(out && out->open(path.string(), spec)) << OIIO::geterror();
  ASSERT_TRUE(out->write_image(spec.format, values.data()) && out->close()) << out->geterror();
}

OIIO::ImageSpec spec_of(int width, int height, int channels, OIIO::TypeDesc type) {
  OIIO::ImageSpec spec(width, height, channels, type);
  spec.alpha_channel = channels % 2 == 0 ? channels - 1 : -1;
  if (channels == 2) spec.channelnames = {"Y", "A"};
  return spec;
}

glm::vec4 pixel(const ColourImage& image, int x, int y) { return image.linear(x, y); }

TEST_F(ImageFile, EightBitRgbIsVerbatim) {
  std::vector<std::uint8_t> values;
  for (int i = 0; i < 5 * 3 * 3; ++i) values.push_back(std::uint8_t(i * 5));
  write_png(folder_ / "rgb.png", 5, 3, 3, values);
  const ColourImage image = read_image(folder_ / "rgb.png");
  EXPECT_EQ(image.width, 5);
  EXPECT_EQ(image.height, 3);
  EXPECT_EQ(image.encoding, ColourImage::Encoding::kSrgb8);
  EXPECT_FALSE(image.has_alpha);
  ASSERT_EQ(image.bytes.size(), 5u * 3 * 4);
  for (int i = 0; i < 15; ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_EQ(image.bytes[i * 4 + c], values[i * 3 + c]);
    EXPECT_EQ(image.bytes[i * 4 + 3], 255);
  }
}

TEST_F(ImageFile, GreyAndAlphaExpandToRgba) {
  write_png(folder_ / "grey.png", 2, 1, 1, std::vector<std::uint8_t>{7, 200});
  EXPECT_THAT(read_image(folder_ / "grey.png").bytes,
              ElementsAre(7, 7, 7, 255, 200, 200, 200, 255));
  write_png(folder_ / "ya.png", 2, 1, 2, std::vector<std::uint8_t>{7, 10, 200, 250});
  const ColourImage ya = read_image(folder_ / "ya.png");
  EXPECT_THAT(ya.bytes, ElementsAre(7, 7, 7, 10, 200, 200, 200, 250));
  EXPECT_TRUE(ya.has_alpha);
}

// Colours under small alpha are what associated alpha would destroy.
TEST_F(ImageFile, StraightAlphaStaysStraight) {
  const std::vector<std::uint8_t> values = {255, 128, 3, 1, 10, 20, 30, 0};
  write_png(folder_ / "rgba.png", 2, 1, 4, values);
  EXPECT_THAT(read_image(folder_ / "rgba.png").bytes, ElementsAreArray(values));
}

TEST_F(ImageFile, PremultipliedTiffIsDivided) {
  OIIO::ImageSpec spec = spec_of(2, 1, 4, OIIO::TypeDesc::UINT8);
  auto out = OIIO::ImageOutput::create("tif");
  const fs::path path = folder_ / "associated.tif";
  const std::uint8_t values[8] = {100, 50, 25, 128, 9, 9, 9, 0};
  ASSERT_TRUE(out->open(path.string(), spec) && out->write_image(OIIO::TypeDesc::UINT8, values) &&
              out->close());
  EXPECT_THAT(read_image(path).bytes, ElementsAre(199, 100, 50, 128, 9, 9, 9, 0));
}

TEST_F(ImageFile, SixteenBitIsDecodedFromSrgbToLinear) {
  const OIIO::ImageSpec spec = spec_of(2, 1, 3, OIIO::TypeDesc::UINT16);
  write_raw<std::uint16_t>(folder_ / "16.png", spec, {65535, 32768, 0, 100, 1000, 10000});
  const ColourImage image = read_image(folder_ / "16.png");
  EXPECT_EQ(image.encoding, ColourImage::Encoding::kLinearHalf);
  EXPECT_EQ(image.bytes.size(), 2u * 8);
  EXPECT_FLOAT_EQ(pixel(image, 0, 0).r, 1.0f);
  EXPECT_NEAR(pixel(image, 0, 0).g, linear_from_srgb(32768 / 65535.0), 2e-4);
  EXPECT_EQ(pixel(image, 0, 0).b, 0.0f);
  EXPECT_NEAR(pixel(image, 1, 0).b, linear_from_srgb(10000 / 65535.0), 2e-5);
  EXPECT_EQ(pixel(image, 1, 0).a, 1.0f);
}

TEST_F(ImageFile, SixteenBitThatDeclaresLinearIsNotDecoded) {
  OIIO::ImageSpec spec = spec_of(1, 1, 3, OIIO::TypeDesc::UINT16);
  spec.attribute("oiio:ColorSpace", "Linear");
  spec.attribute("oiio:Gamma", 1.0f);
  write_raw<std::uint16_t>(folder_ / "linear.png", spec, {65535, 32768, 0});
  EXPECT_NEAR(pixel(read_image(folder_ / "linear.png"), 0, 0).g, 0.5f, 3e-4f);
}

TEST_F(ImageFile, SixteenBitAlphaIsLinearAndStraight) {
  const OIIO::ImageSpec spec = spec_of(1, 1, 4, OIIO::TypeDesc::UINT16);
  write_raw<std::uint16_t>(folder_ / "a.png", spec, {65535, 0, 65535, 16384});
  const glm::vec4 p = pixel(read_image(folder_ / "a.png"), 0, 0);
  EXPECT_NEAR(p.a, 0.25f, 1e-3f);
  EXPECT_EQ(p.r, 1.0f);
}

TEST_F(ImageFile, FloatIsLinearAndBadValuesBecomeZero) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  write_raw<float>(folder_ / "f.exr", spec_of(2, 1, 3, OIIO::TypeDesc::FLOAT),
                   {0.5f, nan, 1e9f, infinity, 2.0f, -infinity});
  const ColourImage image = read_image(folder_ / "f.exr");
  EXPECT_EQ(pixel(image, 0, 0), glm::vec4(0.5f, 0.0f, 65504.0f, 1.0f));
  EXPECT_EQ(pixel(image, 1, 0), glm::vec4(0.0f, 2.0f, 0.0f, 1.0f));
}

TEST_F(ImageFile, ExrColoursAreDividedByAlpha) {
  const half h[4] = {half(0.25f), half(0.5f), half(0.0f), half(0.5f)};
  write_raw<half>(folder_ / "h.exr", spec_of(1, 1, 4, OIIO::TypeDesc::HALF),
                  {h[0], h[1], h[2], h[3]});
  EXPECT_EQ(pixel(read_image(folder_ / "h.exr"), 0, 0), glm::vec4(0.5f, 1.0f, 0.0f, 0.5f));
}

TEST_F(ImageFile, FloatTiffReads) {
  write_raw<float>(folder_ / "f.tif", spec_of(1, 1, 1, OIIO::TypeDesc::FLOAT), {0.75f});
  EXPECT_EQ(pixel(read_image(folder_ / "f.tif"), 0, 0), glm::vec4(0.75f, 0.75f, 0.75f, 1.0f));
}

TEST_F(ImageFile, JpegReads) {
  const std::vector<std::uint8_t> grey(16 * 16 * 3, 120);
  write_raw(folder_ / "j.jpg", spec_of(16, 16, 3, OIIO::TypeDesc::UINT8), grey);
  const ColourImage image = read_image(folder_ / "j.jpg");
  EXPECT_EQ(image.encoding, ColourImage::Encoding::kSrgb8);
  EXPECT_NEAR(image.bytes[0], 120, 1);
  EXPECT_EQ(image.bytes[3], 255);
}

TEST_F(ImageFile, CroppedExrIsRefused) {
  OIIO::ImageSpec spec = spec_of(2, 2, 3, OIIO::TypeDesc::FLOAT);
  spec.x = spec.y = 1;
  spec.full_width = spec.full_height = 8;
  write_raw(folder_ / "crop.exr", spec, std::vector<float>(12, 0.5f));
  EXPECT_THAT(error_of([&] { read_image(folder_ / "crop.exr"); }),
              testing::AllOf(HasSubstr("crop.exr"), HasSubstr("data window")));
}

TEST_F(ImageFile, MaskComesFromLuminanceOrVaryingAlpha) {
  write_png(folder_ / "y.png", 2, 1, 1, std::vector<std::uint8_t>{0, 77});
  EXPECT_THAT(read_mask(folder_ / "y.png").coverage, ElementsAre(0, 77));
  write_png(folder_ / "rgb.png", 3, 1, 3,
            std::vector<std::uint8_t>{255, 255, 255, 0, 255, 0, 0, 0, 0});
  EXPECT_THAT(read_mask(folder_ / "rgb.png").coverage, ElementsAre(255, 182, 0));
  // An object photographed dark on white: only alpha says where it is.
  write_png(folder_ / "rgba.png", 2, 1, 4,
            std::vector<std::uint8_t>{9, 9, 9, 255, 250, 250, 250, 0});
  EXPECT_THAT(read_mask(folder_ / "rgba.png").coverage, ElementsAre(255, 0));
  // Alpha that is the same everywhere says nothing.
  write_png(folder_ / "ya.png", 2, 1, 2, std::vector<std::uint8_t>{0, 255, 255, 255});
  EXPECT_THAT(read_mask(folder_ / "ya.png").coverage, ElementsAre(0, 255));
}

TEST_F(ImageFile, MasksOfOnesAreLabels) {
  write_png(folder_ / "ones.png", 3, 1, 1, std::vector<std::uint8_t>{0, 1, 0});
  const FileMask ones = read_mask(folder_ / "ones.png");
  EXPECT_THAT(ones.coverage, ElementsAre(0, 255, 0));
  EXPECT_TRUE(ones.from_ones);
  write_png(folder_ / "rgb.png", 2, 1, 3, std::vector<std::uint8_t>{1, 1, 1, 0, 0, 0});
  EXPECT_THAT(read_mask(folder_ / "rgb.png").coverage, ElementsAre(255, 0));
  write_png(folder_ / "faint.png", 3, 1, 1, std::vector<std::uint8_t>{0, 1, 2});
  const FileMask faint = read_mask(folder_ / "faint.png");
  EXPECT_THAT(faint.coverage, ElementsAre(0, 1, 2));
  EXPECT_FALSE(faint.from_ones);
  write_png(folder_ / "empty.png", 2, 1, 1, std::vector<std::uint8_t>{0, 0});
  EXPECT_FALSE(read_mask(folder_ / "empty.png").from_ones);
}

TEST_F(ImageFile, WebPAndAvifAreReadAsTheyAreStored) {
  for (const char* name : {"p.webp", "p.avif"}) {
    if (!OIIO::ImageInput::create(name)) continue;  // the sentence below is for these
    OIIO::ImageSpec spec = spec_of(32, 16, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("compression", "lossless");
    const std::vector<std::uint8_t> grey(32 * 16 * 3, 120);
    const auto writer = OIIO::ImageOutput::create((folder_ / name).string());
    if (!writer) continue;
    write_raw(folder_ / name, spec, grey);
    fs::rename(folder_ / name, folder_ / "p.jpg");  // the signature tells
    const ColourImage image = read_image(folder_ / "p.jpg");
    EXPECT_EQ(image.width, 32) << name;
    EXPECT_EQ(image.height, 16) << name;
    EXPECT_NEAR(image.bytes[0], 120, 2) << name;
    EXPECT_EQ(image.bytes[3], 255) << name;
    EXPECT_NEAR(read_image(folder_ / "p.jpg", 0.5).bytes[0], 120, 2) << name;
  }
}

TEST_F(ImageFile, OrientationIsToldAndNotApplied) {
  OIIO::ImageSpec spec = spec_of(32, 16, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("Orientation", 6);
  write_raw(folder_ / "o.jpg", spec, std::vector<std::uint8_t>(32 * 16 * 3, 120));
  const ImageSize size = read_image_size(folder_ / "o.jpg");
  EXPECT_EQ(size.width, 32);
  EXPECT_EQ(size.height, 16);
  EXPECT_EQ(size.orientation, 6);
  write_png(folder_ / "n.png", 2, 1, 1, std::vector<std::uint8_t>{0, 0});
  EXPECT_EQ(read_image_size(folder_ / "n.png").orientation, 1);
}

TEST_F(ImageFile, DeepMasksAreQuantised) {
  write_raw<std::uint16_t>(folder_ / "16.png", spec_of(3, 1, 1, OIIO::TypeDesc::UINT16),
                           {0, 32768, 65535});
  EXPECT_THAT(read_mask(folder_ / "16.png").coverage, ElementsAre(0, 128, 255));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  write_raw<float>(folder_ / "f.exr", spec_of(3, 1, 1, OIIO::TypeDesc::FLOAT), {nan, 0.5f, 7.0f});
  EXPECT_THAT(read_mask(folder_ / "f.exr").coverage, ElementsAre(0, 128, 255));
}

TEST_F(ImageFile, SizeIsReadFromTheHeader) {
  const ImageSize size = read_image_size(put_image("s.png", 31, 17));
  EXPECT_EQ(size.width, 31);
  EXPECT_EQ(size.height, 17);
}

TEST_F(ImageFile, MissingOrForeignFilesAreNamed) {
  EXPECT_THAT(error_of([&] { read_image(folder_ / "gone.png"); }), HasSubstr("gone.png"));
  const fs::path text = put("text.png", "this is no image at all");
  EXPECT_THAT(error_of([&] { read_image(text); }),
              testing::AllOf(HasSubstr("text.png"), HasSubstr("cannot be read as an image"),
                             HasSubstr("PNG, JPEG, TIFF, OpenEXR")));
  EXPECT_THAT(error_of([&] { read_image(folder_); }), HasSubstr("no such image file"));
}

std::string contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_F(ImageFile, FilesCutShortAreRefused) {
  std::vector<std::uint8_t> noise(64 * 64 * 3);
  std::uint32_t state = 1;
  for (std::uint8_t& value : noise)
    value = std::uint8_t((state = state * 1664525 + 1013904223) >> 24);
  for (const char* extension : {".png", ".jpg", ".tif"}) {
    const fs::path whole = folder_ / (std::string("whole") + extension);
    write_raw(whole, spec_of(64, 64, 3, OIIO::TypeDesc::UINT8), noise);
    const std::string bytes = contents(whole);
    const fs::path cut = put(std::string("cut") + extension, bytes.substr(0, bytes.size() / 2));
    EXPECT_THAT(error_of([&] { read_image(cut); }), HasSubstr(cut.string()));
  }
}

// The header alone claims the size, so the guard must act before any memory is asked for.
TEST_F(ImageFile, AbsurdSizesAreRefused) {
  std::string pgm = "P5\n60000 60000\n255\n";
  const fs::path path = put("bomb.pgm", pgm);
  EXPECT_THAT(error_of([&] { read_image(path); }),
              testing::AllOf(HasSubstr("bomb.pgm"), HasSubstr("60000 x 60000")));
  EXPECT_THAT(error_of([&] { read_mask(path); }), HasSubstr("60000 x 60000"));
}

TEST_F(ImageFile, TheSignatureNotTheNameChoosesTheDecoder) {
  write_png(folder_ / "a.png", 1, 1, 3, std::vector<std::uint8_t>{4, 5, 6});
  fs::rename(folder_ / "a.png", folder_ / "a.jpg");
  EXPECT_THAT(read_image(folder_ / "a.jpg").bytes, ElementsAre(4, 5, 6, 255));
  const fs::path gif = put("b.png", "GIF89a\1\0\1\0");
  EXPECT_THAT(error_of([&] { read_image(gif); }), HasSubstr("beginning is none that is known"));
}

TEST_F(ImageFile, OpenExrAttributesOfImpossibleLengthAreRefused) {
  const fs::path path = folder_ / "a.exr";
  write_raw(path, spec_of(2, 2, 3, OIIO::TypeDesc::FLOAT), std::vector<float>(12));
  std::ifstream in(path, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(in), {}};
  const std::size_t at = whole.find("lineOrder") + 20;  // behind the name and the type
  for (const auto& [length, message] :
       {std::pair('\x7f', "no end"), std::pair('\0', "another length")}) {
    std::string damaged = whole;
    damaged[at + 2] = length;
    damaged[at] = length == 0 ? 4 : damaged[at];
    EXPECT_THAT(error_of([&] { read_image(put("a.exr", damaged)); }), HasSubstr(message));
  }
}

TEST_F(ImageFile, ThreadsDecodeSideBySide) {
  std::vector<std::uint16_t> values(64 * 64 * 3);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::uint16_t(i * 5);
  write_raw(folder_ / "16.png", spec_of(64, 64, 3, OIIO::TypeDesc::UINT16), values);
  std::vector<ColourImage> images(8);
  {
    std::vector<std::jthread> threads;
    for (ColourImage& image : images)
      threads.emplace_back([&] { image = read_image(folder_ / "16.png"); });
  }
  for (const ColourImage& image : images) EXPECT_EQ(image.bytes, images[0].bytes);
  EXPECT_EQ(images[0].bytes.size(), 64u * 64 * 8);
}

TEST_F(ImageFile, PngsAppearWholeOrNotAtAll) {
  const std::vector<std::uint8_t> pixel = {1, 2, 3};
  const fs::path nowhere = folder_ / "missing" / "x.png";
  EXPECT_THAT(error_of([&] { write_png(nowhere, 1, 1, 3, pixel); }), HasSubstr(nowhere.string()));
  write_png(folder_ / "x.png", 1, 1, 3, pixel);
  write_png(folder_ / "x.png", 1, 1, 3, std::vector<std::uint8_t>{4, 5, 6});
  EXPECT_THAT(read_image(folder_ / "x.png").bytes, ElementsAre(4, 5, 6, 255));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1) << "a temporary file is left";
}

}  // namespace
}  // namespace photohull::io

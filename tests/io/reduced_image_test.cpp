// Image files read at a scale, against averages over areas in double precision.
#include <OpenImageIO/half.h>
#include <OpenImageIO/imageio.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "core/image_scale.h"
#include "io/image_file.h"
#include "scene_fixture.h"

namespace photohull::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

using ReducedImage = TemporaryFolder;

constexpr double kScales[] = {0.5, 0.25, 0.125, 1.0 / 3, 0.3, 0.77};
constexpr glm::ivec2 kSizes[] = {{64, 48}, {65, 47}, {61, 33}, {9, 70}};

/// Writes interleaved values as they are.
template <typename T>
void write(const fs::path& path, OIIO::ImageSpec spec, const std::vector<T>& values) {
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.attribute("CompressionQuality", 100);
  spec.attribute("jpeg:subsampling", "4:4:4");
  auto out = OIIO::ImageOutput::create(path.string());
  ASSERT_TRUE(out && out->open(path.string(), spec)) << OIIO::geterror();
  ASSERT_TRUE(out->write_image(spec.format, values.data()) && out->close()) << out->geterror();
}

/// Mean of value(x, y) over the smaller picture's pixel (i, j), as much of it as is in the picture.
double area_mean(int i, int j, const glm::ivec2& size, double scale,
                 const std::function<double(int, int)>& value) {
  double sum = 0, area = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const double w = std::min(x + 1.0, (i + 1) / scale) - std::max(double(x), i / scale);
      const double h = std::min(y + 1.0, (j + 1) / scale) - std::max(double(y), j / scale);
      if (w <= 0 || h <= 0) continue;
      sum += w * h * value(x, y);
      area += w * h;
    }
  return sum / area;
}

/// Values that differ from pixel to pixel without order.
std::vector<std::uint8_t> noise(std::size_t count) {
  std::vector<std::uint8_t> out(count);
  std::uint32_t state = 1;
  for (auto& value : out) value = std::uint8_t((state = state * 1664525 + 1013904223) >> 24);
  return out;
}

TEST_F(ReducedImage, EightBitsAreAveragedInLinearLight) {
  for (const glm::ivec2 size : kSizes) {
    const auto values = noise(std::size_t(size.x * size.y * 3));
    write_png(folder_ / "a.png", size.x, size.y, 3, values);
    for (const double scale : kScales) {
      const ColourImage image = read_image(folder_ / "a.png", scale);
      ASSERT_EQ(image.width, int(std::ceil(size.x * scale - 1e-9)));
      ASSERT_EQ(image.height, int(std::ceil(size.y * scale - 1e-9)));
      ASSERT_EQ(image.bytes.size(), std::size_t(image.width * image.height * 4));
      for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
          for (int c = 0; c < 3; ++c) {
            const double linear = area_mean(x, y, size, scale, [&](int u, int v) {
              return linear_from_srgb(values[std::size_t((v * size.x + u) * 3 + c)] / 255.0);
            });
            ASSERT_NEAR(image.bytes[std::size_t((y * image.width + x) * 4 + c)],
                        255 * srgb_from_linear(linear), 0.6)
                << size.x << " x " << size.y << " at " << scale << ": " << x << ", " << y;
          }
    }
  }
}

TEST_F(ReducedImage, SixteenBitsAndFloatsInTilesToo) {
  const glm::ivec2 size(61, 47);
  const auto raw = noise(std::size_t(size.x * size.y * 4));
  std::vector<std::uint16_t> deep;
  std::vector<float> real;
  for (const std::uint8_t v : raw)
    deep.push_back(std::uint16_t(v * 257)), real.push_back(v / 64.0f);
  OIIO::ImageSpec spec(size.x, size.y, 3, OIIO::TypeDesc::UINT16);
  deep.resize(std::size_t(size.x * size.y * 3));
  real.resize(deep.size());
  write(folder_ / "deep.png", spec, deep);
  spec.format = OIIO::TypeDesc::FLOAT;
  write(folder_ / "real.exr", spec, real);
  spec.tile_width = spec.tile_height = 16;
  write(folder_ / "tiled.tif", spec, real);
  const std::pair<const char*, bool> files[] = {
      {"deep.png", true}, {"real.exr", false}, {"tiled.tif", false}};
  for (const auto& [name, is_srgb] : files) {
    const bool srgb = is_srgb;  // a lambda may not capture the other (before clang 16)
    const ColourImage image = read_image(folder_ / name, 0.25);
    ASSERT_EQ(image.encoding, ColourImage::Encoding::kLinearHalf);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        for (int c = 0; c < 3; ++c) {
          const double mean = area_mean(x, y, size, 0.25, [&](int u, int v) {
            const auto at = std::size_t((v * size.x + u) * 3 + c);
            return srgb ? linear_from_srgb(deep[at] / 65535.0) : double(real[at]);
          });
          ASSERT_NEAR(image.linear(x, y)[c], mean, 1e-3 * std::max(mean, 1.0)) << name;
        }
  }
}

TEST_F(ReducedImage, JpegAgreesWithTheAverageOfSmoothContent) {
  for (const glm::ivec2 size : {glm::ivec2(96, 64), glm::ivec2(97, 61), glm::ivec2(103, 70)}) {
    std::vector<std::uint8_t> values;
    const auto light = [&](int x, int y, int c) {
      return std::uint8_t(std::lround(128 + 90 * std::sin(0.05 * x + c) * std::cos(0.04 * y)));
    };
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        for (int c = 0; c < 3; ++c) values.push_back(light(x, y, c));
    write(folder_ / "a.jpg", OIIO::ImageSpec(size.x, size.y, 3, OIIO::TypeDesc::UINT8), values);
    for (const double scale : {0.5, 0.25, 0.125, 0.3, 1.0 / 16}) {
      const ColourImage image = read_image(folder_ / "a.jpg", scale);
      ASSERT_EQ(image.width, scaled_length(size.x, scale));
      ASSERT_EQ(image.height, scaled_length(size.y, scale));
      // Pixels that stand out of the file show what the encoder filled its blocks with.
      for (int y = 0; y + 1 < image.height; ++y)
        for (int x = 0; x + 1 < image.width; ++x)
          for (int c = 0; c < 3; ++c) {
            const double mean = area_mean(x, y, size, scale, [&](int u, int v) {
              return linear_from_srgb(light(u, v, c) / 255.0);
            });
            // A shift by half a pixel of the file changes values by more than 2 already.
            ASSERT_NEAR(image.bytes[std::size_t((y * image.width + x) * 4 + c)],
                        255 * srgb_from_linear(mean), 3)
                << size.x << " x " << size.y << " at " << scale << ": " << x << ", " << y;
          }
    }
  }
}

TEST_F(ReducedImage, GreyJpegIsRead) {
  write(folder_ / "a.jpg", OIIO::ImageSpec(40, 24, 1, OIIO::TypeDesc::UINT8),
        std::vector<std::uint8_t>(40 * 24, 77));
  const ColourImage image = read_image(folder_ / "a.jpg", 0.5);
  for (std::size_t i = 0; i < image.bytes.size(); ++i)
    ASSERT_NEAR(image.bytes[i], i % 4 == 3 ? 255 : 77, 1);
}

TEST_F(ReducedImage, DamagedFilesAreRefused) {
  const auto values = noise(200 * 150 * 3);
  const OIIO::ImageSpec spec(200, 150, 3, OIIO::TypeDesc::UINT8);
  for (const char* name : {"a.jpg", "a.png"}) {
    write(folder_ / name, spec, values);
    fs::resize_file(folder_ / name, fs::file_size(folder_ / name) / 2);
    for (const double scale : {0.5, 0.3}) {
      try {
        read_image(folder_ / name, scale);
        ADD_FAILURE() << name;
      } catch (const Error& e) {
        EXPECT_THAT(e.what(), HasSubstr(name));
        EXPECT_THAT(e.what(), HasSubstr("damaged or cut short"));
      }
    }
  }
}

TEST_F(ReducedImage, MasksKeepTheSumOfTheirCoverage) {
  for (const glm::ivec2 size : kSizes) {
    auto values = noise(std::size_t(size.x * size.y));
    for (std::size_t i = 0; i < values.size(); i += 3) values[i] = 0;  // thin parts in the dark
    write_png(folder_ / "m.png", size.x, size.y, 1, values);
    double total = 0;
    for (const std::uint8_t v : values) total += v;
    for (const double scale : kScales) {
      const Mask mask = read_mask(folder_ / "m.png", scale);
      ASSERT_EQ(mask.width, scaled_length(size.x, scale));
      double sum = 0, area = 0;
      for (int y = 0; y < mask.height; ++y)
        for (int x = 0; x < mask.width; ++x) {
          const double w = std::min((x + 1) / scale, double(size.x)) - x / scale;
          const double h = std::min((y + 1) / scale, double(size.y)) - y / scale;
          const double coverage = mask.coverage[std::size_t(y * mask.width + x)];
          ASSERT_NEAR(
              coverage,
              area_mean(x, y, size, scale,
                        [&](int u, int v) { return double(values[std::size_t(v * size.x + u)]); }),
              0.51);
          sum += w * h * coverage;
          area += w * h;
        }
      EXPECT_NEAR(sum, total, 0.15 * area) << scale;  // rounding's mean is far less than 0.5
    }
  }
}

TEST_F(ReducedImage, AMaskIsTheAlphaThatVaries) {
  std::vector<std::uint8_t> varying, constant;
  for (int i = 0; i < 16 * 16; ++i) {
    varying.insert(varying.end(), {9, 9, 9, std::uint8_t(i % 16 < 8 ? 0 : 255)});
    constant.insert(constant.end(), {9, 9, 9, 255});
  }
  write_png(folder_ / "varying.png", 16, 16, 4, varying);
  write_png(folder_ / "constant.png", 16, 16, 4, constant);
  const Mask a = read_mask(folder_ / "varying.png", 0.25);
  EXPECT_EQ(a.coverage[1], 0);
  EXPECT_EQ(a.coverage[2], 255);
  EXPECT_EQ(read_mask(folder_ / "constant.png", 0.25).coverage[0], 9);
}

TEST_F(ReducedImage, MasksOfOnesKeepTheirCoverage) {
  std::vector<std::uint8_t> ones;
  for (int i = 0; i < 16 * 16; ++i) ones.push_back(i % 16 < 6);
  write_png(folder_ / "ones.png", 16, 16, 1, ones);
  const FileMask mask = read_mask(folder_ / "ones.png", 0.25);
  EXPECT_TRUE(mask.from_ones);
  EXPECT_EQ(mask.coverage[0], 255);
  EXPECT_NEAR(mask.coverage[1], 127.5, 1);
  EXPECT_EQ(mask.coverage[2], 0);
  for (std::uint8_t& value : ones) value *= 2;
  write_png(folder_ / "twos.png", 16, 16, 1, ones);
  EXPECT_FALSE(read_mask(folder_ / "twos.png", 0.25).from_ones);
  EXPECT_EQ(read_mask(folder_ / "twos.png", 0.25).coverage[0], 2);
}

/// A blurred spot where a camera sees a point lies where the scaled camera sees it.
TEST_F(ReducedImage, ScaledCamerasSeeTheSameContent) {
  Camera camera;
  camera.intrinsics = {403, 301, 380, 390, 2, 190.3, 160.8};
  const glm::dvec3 point(0.12, -0.09, 1.7);
  const glm::dvec2 place = *camera.project(point);
  std::vector<std::uint8_t> values;
  for (int y = 0; y < 301; ++y)
    for (int x = 0; x < 403; ++x) {
      const glm::dvec2 d = glm::dvec2(x, y) - place;
      const auto value = std::uint8_t(std::lround(200 * std::exp(-glm::dot(d, d) / (2 * 18 * 18))));
      values.insert(values.end(), 3, value);
    }
  const OIIO::ImageSpec spec(403, 301, 3, OIIO::TypeDesc::UINT8);
  write(folder_ / "a.jpg", spec, values);
  write(folder_ / "a.png", spec, values);
  for (const char* name : {"a.jpg", "a.png"})
    for (const double scale : {0.5, 0.25, 0.125, 0.3}) {
      const ColourImage image = read_image(folder_ / name, scale);
      Camera scaled = camera;
      scaled.intrinsics = scaled_intrinsics(camera.intrinsics, scale);
      ASSERT_EQ(image.width, scaled.intrinsics.width);
      ASSERT_EQ(image.height, scaled.intrinsics.height);
      glm::dvec2 centroid(0);
      double sum = 0;
      for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
          const double w = image.bytes[std::size_t((y * image.width + x) * 4)];
          if (w < 6) continue;
          centroid += w * glm::dvec2(x, y);
          sum += w;
        }
      // Half a pixel of the file, the usual mistake, is 0.06 pixels at 1/8.
      EXPECT_LT(glm::length(centroid / sum - *scaled.project(point)), 0.025) << name << scale;
    }
}

TEST_F(ReducedImage, AScaleOfOneIsThePlainImage) {
  const auto values = noise(31 * 17 * 3);
  write_png(folder_ / "a.png", 31, 17, 3, values);
  EXPECT_EQ(read_image(folder_ / "a.png", 1).bytes, read_image(folder_ / "a.png").bytes);
}

}  // namespace
}  // namespace photohull::io

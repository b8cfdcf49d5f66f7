// The same photographs in every scene format and pixel type give the same reconstruction.
#include <OpenImageIO/imageio.h>

#include <nlohmann/json.hpp>

#include "io/image_file.h"
#include "io/mesh/write_mesh.h"
#include "io/write_scene.h"
#include "sphere_scene.h"
#include "support/analytic_volumes.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Linear RGBA of a photograph.
std::vector<float> linear_pixels(const std::string& file) {
  const ColourImage image = io::read_image(file);
  std::vector<float> pixels;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 4; ++c) pixels.push_back(image.linear(x, y)[c]);
  return pixels;
}

class Formats : public SphereScene {
 protected:
  struct Result {
    double volume;
    json report;
  };
  /// A silhouette reconstruction of the scene at `scene`.
  Result reconstruct_from(const std::string& scene, const Arguments& more) const {
    Arguments all = {"reconstruct",  scene, "--out",    out(),
                     "--resolution", "32",  "--method", "hull"};
    all.insert(all.end(), more.begin(), more.end());
    succeed(all);
    return {signed_volume(read_ply(path("out/mesh.ply"))),
            json::parse(read_bytes(path("out/report.json")))};
  }
  void write_exr(const std::string& file, const std::vector<float>& pixels) const {
    const auto output = OIIO::ImageOutput::create(file);
    ASSERT_TRUE(output);
    ASSERT_TRUE(output->open(file, OIIO::ImageSpec(kWidth, kHeight, 4, OIIO::TypeDesc::HALF)));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()));
    ASSERT_TRUE(output->close());
  }
  void write_16bit(const std::string& file, std::vector<float> pixels) const {
    OIIO::ImageSpec spec(kWidth, kHeight, 4, OIIO::TypeDesc::UINT16);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    for (std::size_t i = 0; i < pixels.size(); ++i)
      if (i % 4 != 3) pixels[i] = float(srgb_from_linear(pixels[i]));
    const auto output = OIIO::ImageOutput::create(file);
    ASSERT_TRUE(output);
    ASSERT_TRUE(output->open(file, spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()));
    ASSERT_TRUE(output->close());
  }
};

TEST_F(Formats, AllFourGiveTheSameVolume) {
  io::write_colmap_text(scene_, folder_ / "t");
  io::write_colmap_binary(scene_, folder_ / "b");
  io::write_transforms(scene_, folder_ / "j");
  const Arguments masks = {"--masks", path("cutouts")};
  const double expected = reconstruct_from(scene(), masks).volume;
  const std::pair<const char*, const char*> others[] = {
      {"t", "colmap-text"}, {"b", "colmap-binary"}, {"j/transforms.json", "transforms"}};
  for (const auto& [name, format] : others) {
    const Result result = reconstruct_from(path(name), masks);
    EXPECT_EQ(result.report["scene"]["format"], format);
    EXPECT_NEAR(result.volume, expected, 1e-4 * expected) << name;
  }
}

TEST_F(Formats, PixelCenterShiftsTheCameras) {
  // The principal points now stand half a pixel too far to the lower right for the convention 0.
  for (SourceView& view : scene_.views) {
    view.camera.intrinsics.cx += 0.5;
    view.camera.intrinsics.cy += 0.5;
  }
  const Arguments masks = {"--masks", path("cutouts")};
  const double expected = reconstruct_from(scene(), masks).volume;
  write_scene_file();
  const double wrong =
      reconstruct_from(scene(), {"--masks", path("cutouts"), "--refine-cameras", "off"}).volume;
  const Result right =
      reconstruct_from(scene(), {"--masks", path("cutouts"), "--pixel-center", "0.5"});
  EXPECT_NEAR(right.volume, expected, 1e-4 * expected);
  EXPECT_GT(std::abs(wrong - expected), 1e-3 * expected);
  EXPECT_EQ(right.report["options"]["pixel_center"], "0.5");
}

TEST_F(Formats, DeepImagesAndAlphaMasksWork) {
  for (std::size_t i = 0; i < scene_.views.size(); ++i) {
    std::vector<float> pixels = linear_pixels(image(int(i)));
    const Mask mask = io::read_mask(mask_file(int(i)));
    for (std::size_t p = 0; p < mask.coverage.size(); ++p)
      pixels[4 * p + 3] = float(mask.coverage[p]) / 255;
    fs::remove(image(int(i)));
    if (i % 2 == 0) {
      write_16bit(image(int(i)), pixels);
      continue;
    }
    for (std::size_t p = 0; p < pixels.size(); ++p)  // OpenEXR stores colours multiplied by alpha
      if (p % 4 != 3) pixels[p] *= pixels[p / 4 * 4 + 3];
    scene_.views[i].name = "view" + std::to_string(i) + ".exr";
    scene_.views[i].image = folder_ / "images" / scene_.views[i].name;
    write_exr(image(int(i)), pixels);
  }
  write_scene_file();
  const Result result = reconstruct_from(scene(), {});
  EXPECT_EQ(result.report["masks"]["source"], "alpha channels");
  EXPECT_NEAR(result.volume, 1.05 * kSphereVolume, 0.08 * kSphereVolume);
}

TEST_F(Formats, MasksStandInTransforms) {
  for (std::size_t i = 0; i < scene_.views.size(); ++i) scene_.views[i].mask = mask_file(int(i));
  io::write_transforms(scene_, folder_ / "j");
  const Result result = reconstruct_from(path("j"), {});
  EXPECT_EQ(result.report["masks"]["source"], "mask files");
  EXPECT_EQ(result.report["masks"]["confidence"], 1.0);
  EXPECT_EQ(result.report["box"]["source"], "aabb of transforms.json");
}

TEST_F(Formats, NamesThatAreNotUtf8StillGiveJson) {
  const std::string name =
      "\xfc"
      "nder.png";  // Latin-1
  fs::rename(image(3), folder_ / "images" / name);
  scene_.views[3].name = name;
  scene_.views[3].image = folder_ / "images" / name;
  write_scene_file();
  const Finished info = succeed({"info", scene(), "--json"});
  EXPECT_TRUE(json::accept(info.out));
  const Finished run = succeed({"reconstruct", scene(), "--out", path("out\xff"), "--resolution",
                                "32", "--method", "hull", "--views", "*", "--json"});
  EXPECT_TRUE(json::accept(run.out));
}

}  // namespace
}  // namespace photohull::test

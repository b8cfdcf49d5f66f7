#include "damaged_pictures.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imagecache.h>

#include <functional>
#include <map>
#include <stdexcept>
#include <vector>

#include "../calib/rendered_boards.h"
#include "damaged_scenes.h"
#include "io/image_file.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
namespace algo = OIIO::ImageBufAlgo;
using nlohmann::json;
using OIIO::ImageBuf;

/// Changes one picture; the numbers are what the mistake needs beside it.
using Change = std::function<ImageBuf(const ImageBuf&, const std::vector<double>& numbers)>;

ImageBuf painted(const ImageBuf& image, const std::vector<double>& n) {
  ImageBuf out(image.spec());
  algo::fill(out, std::vector<float>(std::size_t(image.nchannels()), float(n[0])));
  return out;
}

ImageBuf blurred(const ImageBuf& image, const std::vector<double>& n) {
  const float width = float(6 * n[0]);
  return algo::convolve(image, algo::make_kernel("gaussian", width, width));
}

ImageBuf in_grey(const ImageBuf& image, const std::vector<double>&) {
  return algo::channels(image, 1, {1});
}

ImageBuf with_alpha(const ImageBuf& image, const std::vector<double>& n) {
  ImageBuf out =
      algo::channels(image, 4, {0, 1, 2, -1}, {0, 0, 0, float(n[0])}, {"R", "G", "B", "A"});
  out.specmod().alpha_channel = 3;
  out.specmod().attribute("oiio:UnassociatedAlpha", 1);
  return out;
}

ImageBuf resized(const ImageBuf& image, const std::vector<double>& n) {
  return algo::resize(image, {}, OIIO::ROI(0, int(n[0]), 0, int(n[1]), 0, 1, 0, image.nchannels()));
}

ImageBuf shifted(const ImageBuf& image, const std::vector<double>& n) {
  return algo::circular_shift(image, int(n[0]), int(n[1]));
}

ImageBuf eroded(const ImageBuf& image, const std::vector<double>& n) {
  const int side = 2 * int(n[0]) + 1;
  return algo::erode(image, side, side);
}

/// 0 and 1 of 255 in place of black and white.
ImageBuf in_ones(const ImageBuf& image, const std::vector<double>&) {
  ImageBuf out = image;
  for (ImageBuf::Iterator<float> pixel(out); !pixel.done(); ++pixel)
    pixel[0] = pixel[0] > 0.5f ? 1.0f / 255 : 0.0f;
  return out;
}

const std::map<std::string, Change>& changes() {
  static const std::map<std::string, Change> all = {
      {"paint", painted},
      {"brighten", [](const ImageBuf& i, const auto& n) { return algo::mul(i, float(n[0])); }},
      {"blur", blurred},
      {"grey", in_grey},
      {"add alpha", with_alpha},
      {"turn", [](const ImageBuf& i, const auto&) { return algo::rotate90(i); }},
      {"turn upside down", [](const ImageBuf& i, const auto&) { return algo::rotate180(i); }},
      {"mirror", [](const ImageBuf& i, const auto&) { return algo::flop(i); }},
      {"invert", [](const ImageBuf& i, const auto&) { return algo::invert(i); }},
      {"resize", resized},
      {"shift", shifted},
      {"erode", eroded},
      {"make ones", in_ones},
      {"store in 16 bits", [](const ImageBuf& i, const auto&) { return i; }},
      {"store with orientation", [](const ImageBuf& i, const auto&) { return i; }},
  };
  return all;
}

/// JPEG where a tag must be kept; readers go by what a file holds and not by its name.
void store(ImageBuf image, const std::string& name, const std::vector<double>& numbers,
           const fs::path& file) {
  const bool tagged = name == "store with orientation";
  if (tagged) image.specmod().attribute("Orientation", int(numbers[0]));
  const fs::path temporary = file.string() + (tagged ? ".new.jpg" : ".new.png");
  const auto type = name == "store in 16 bits" ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8;
  if (!image.write(temporary.string(), type))
    throw std::runtime_error(file.string() + ": " + image.geterror());
  fs::rename(temporary, file);
}

/// ["boards", FOLDER, COLUMNS, ROWS, COUNT, "chess", "charuco" or "flat"]: photographs of a board,
/// tilted in all ways, or flat on a turntable that turns by 20 degrees.
void photograph_boards(const fs::path& folder, const json& mistake) {
  const int columns = mistake[2], rows = mistake[3];
  const std::string kind = mistake[5];
  Truth lens;
  lens.k = {320, 240, 306, 306, 0, 161, 118};
  lens.lens = {};
  const glm::dvec2 middle =
      kind == "charuco" ? glm::dvec2(columns, rows) / 2.0 : glm::dvec2(columns - 1, rows - 1) / 2.0;
  const glm::dvec3 axis = glm::normalize(glm::dvec3(0.02, -0.8, -0.6));
  const glm::dvec3 x = glm::normalize(glm::cross(axis, glm::dvec3(0, 0, 1)));
  const glm::dmat3 flat(x, -glm::cross(axis, x), -axis);
  fs::create_directories(folder);
  for (int i = 0; i < int(mistake[4]); ++i) {
    Pose pose = pose_of(i, middle, 11);
    if (kind == "flat") {
      pose.rotation = glm::mat3_cast(glm::angleAxis(20 * i * kRadian, axis)) * flat;
      pose.translation = glm::dvec3(0, 0, 11) - pose.rotation * glm::dvec3(middle, 0);
    }
    const ColourImage image =
        photograph(lens, pose, kind == "charuco" ? charuco(columns, rows) : chess(columns, rows));
    io::write_png(folder / concat(i, ".png"), image.width, image.height, 4, image.bytes);
  }
}

}  // namespace

bool damage_pictures(const fs::path& folder, const json& mistake) {
  const std::string name = mistake[0];
  if (name == "boards") {
    photograph_boards(folder / mistake[1].get<std::string>(), mistake);
    return true;
  }
  const auto change = changes().find(name);
  if (change == changes().end()) return false;
  std::vector<double> numbers;
  for (std::size_t i = 2; i < mistake.size(); ++i) numbers.push_back(mistake[i]);
  for (const fs::path& file : files_named(folder, mistake[1])) {
    // Or the cache would have it as it was before an earlier mistake.
    OIIO::ImageCache::create()->invalidate(OIIO::ustring(file.string()), true);
    ImageBuf image(file.string());
    if (!image.read(0, 0, true, OIIO::TypeDesc::FLOAT))
      throw std::runtime_error(file.string() + ": " + image.geterror());
    store(change->second(image, numbers), name, numbers, file);
  }
  return true;
}

}  // namespace photohull::test

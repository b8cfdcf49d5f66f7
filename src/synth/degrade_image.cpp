#include "synth/degrade_image.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/image.h"
#include "synth/random.h"

namespace photohull::synth {
namespace {

enum Stream : std::uint64_t {
  kGains = 0x6a105,
  kNoise = 0x20153,
  kCodeNoise = 0x20154,
  kMotion = 0x20155
};

std::vector<float> gaussian(double sigma) {
  const int reach = std::max(1, int(std::ceil(4 * sigma)));
  std::vector<float> weights;
  double sum = 0;
  for (int i = -reach; i <= reach; ++i) {
    weights.push_back(float(std::exp(-0.5 * i * i / (sigma * sigma))));
    sum += weights.back();
  }
  for (float& w : weights) w = float(w / sum);
  return weights;
}

void vignette(std::vector<glm::vec3>& image, int width, int height, double strength) {
  const double x0 = (width - 1) / 2.0, y0 = (height - 1) / 2.0, corner = x0 * x0 + y0 * y0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double r2 = ((x - x0) * (x - x0) + (y - y0) * (y - y0)) / corner;
      image[std::size_t(y) * width + x] *= float(1 - strength * r2);
    }
}

/// Linear light to 8-bit sRGB by the thresholds between the codes.
std::uint8_t encode(float linear) {
  static const std::vector<float> thresholds = [] {
    std::vector<float> t;
    for (int code = 1; code < 256; ++code) t.push_back(float(linear_from_srgb((code - 0.5) / 255)));
    return t;
  }();
  return std::uint8_t(std::upper_bound(thresholds.begin(), thresholds.end(), linear) -
                      thresholds.begin());
}

}  // namespace

glm::vec3 view_gain(const DegradationSpec& spec, std::uint64_t seed, std::size_t view) {
  Random random(seed, kGains, view);
  const double stops = spec.exposure * random.normal();
  const double red = spec.white_balance * random.normal();
  const double blue = spec.white_balance * random.normal();
  return {float(std::exp2(stops + red)), float(std::exp2(stops)), float(std::exp2(stops + blue))};
}

void blur(std::vector<glm::vec3>& image, int width, int height, double sigma) {
  if (sigma <= 0) return;
  const std::vector<float> weights = gaussian(sigma);
  const int reach = int(weights.size() / 2);
  std::vector<glm::vec3> rows(image.size());
  const auto pass = [&](const std::vector<glm::vec3>& in, std::vector<glm::vec3>& out,
                        bool across) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        glm::vec3 sum(0);
        for (int i = -reach; i <= reach; ++i) {
          const int u = across ? std::clamp(x + i, 0, width - 1) : x;
          const int v = across ? y : std::clamp(y + i, 0, height - 1);
          sum += weights[std::size_t(i + reach)] * in[std::size_t(v) * width + u];
        }
        out[std::size_t(y) * width + x] = sum;
      }
  };
  pass(image, rows, true);
  pass(rows, image, false);
}

void blur_edges(std::vector<glm::vec3>& image, int width, int height, double sigma) {
  if (sigma <= 0) return;
  constexpr int kLevels = 4;  // between which colours are mixed
  std::vector<std::vector<glm::vec3>> levels(kLevels + 1, image);
  for (int i = 1; i <= kLevels; ++i)
    blur(levels[std::size_t(i)], width, height, sigma * i / kLevels);
  const double x0 = (width - 1) / 2.0, y0 = (height - 1) / 2.0, corner = x0 * x0 + y0 * y0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double at = kLevels * ((x - x0) * (x - x0) + (y - y0) * (y - y0)) / corner;
      const int low = std::clamp(int(at), 0, kLevels - 1);
      const std::size_t i = std::size_t(y) * width + x;
      image[i] = mix(levels[std::size_t(low)][i], levels[std::size_t(low + 1)][i], float(at - low));
    }
}

bool is_motion_blurred(const DegradationSpec& spec, std::size_t view) {
  if (!(spec.motion_blur > 0)) return false;
  const double share = spec.motion_blur_views;
  return std::floor(double(view + 1) * share + 1e-9) > std::floor(double(view) * share + 1e-9);
}

void motion_blur(std::vector<glm::vec3>& image, int width, int height, double length,
                 double angle) {
  const int steps = int(std::ceil(2 * length));  // two samples a pixel
  if (steps < 1) return;
  const std::vector<glm::vec3> sharp = image;
  const auto at = [&](int x, int y) {
    return sharp[std::size_t(std::clamp(y, 0, height - 1)) * width + std::clamp(x, 0, width - 1)];
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      glm::vec3 sum(0);
      for (int i = 0; i <= steps; ++i) {
        const double along = (double(i) / steps - 0.5) * length;
        const double u = x + along * std::cos(angle), v = y + along * std::sin(angle);
        const int x0 = int(std::floor(u)), y0 = int(std::floor(v));
        const float a = float(u - x0), b = float(v - y0);
        sum += (1 - b) * ((1 - a) * at(x0, y0) + a * at(x0 + 1, y0)) +
               b * ((1 - a) * at(x0, y0 + 1) + a * at(x0 + 1, y0 + 1));
      }
      image[std::size_t(y) * width + x] = sum / float(steps + 1);
    }
}

std::vector<std::uint8_t> through_jpeg(std::span<const std::uint8_t> rgb, int width, int height,
                                       int quality) {
  const auto fail = [](const std::string& what) {
    throw Error("a picture cannot be coded as JPEG (" + what + "); set degradations.jpeg to 0");
  };
  OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("Compression", concat("jpeg:", quality));
  std::vector<unsigned char> coded;
  OIIO::Filesystem::IOVecOutput memory(coded);
  const auto output = OIIO::ImageOutput::create("jpeg");
  if (!output || !output->supports("ioproxy")) fail("OpenImageIO cannot write it to memory");
  output->threads(1);
  if (!output->set_ioproxy(&memory) || !output->open("memory.jpg", spec) ||
      !output->write_image(OIIO::TypeDesc::UINT8, rgb.data()) || !output->close())
    fail(output->geterror());
  OIIO::Filesystem::IOMemReader stored(coded.data(), coded.size());
  const auto input = OIIO::ImageInput::open("memory.jpg", nullptr, &stored);
  if (!input) fail(OIIO::geterror());
  input->threads(1);
  std::vector<std::uint8_t> decoded(rgb.size());
  if (input->spec().width != width || input->spec().height != height ||
      input->spec().nchannels != 3 ||
      !input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, decoded.data()))
    fail(input->geterror());
  return decoded;
}

namespace {

/// Noise of the stored codes, in linear light again.
float add_code_noise(float light, double sigma, Random& random) {
  const double code = srgb_from_linear(std::clamp(light, 0.0f, 1.0f)) + sigma * random.normal();
  return float(linear_from_srgb(std::clamp(code, 0.0, 1.0)));
}

/// What the sensor reads, in linear light, 1 = white.
std::vector<glm::vec3> develop(const Picture& picture, const DegradationSpec& spec,
                               std::uint64_t seed, std::size_t view, std::uint64_t take) {
  std::vector<glm::vec3> image = picture.colour;
  if (spec.vignetting > 0) vignette(image, picture.width, picture.height, spec.vignetting);
  blur(image, picture.width, picture.height, spec.blur);
  blur_edges(image, picture.width, picture.height, spec.edge_blur);
  if (is_motion_blurred(spec, view))
    motion_blur(image, picture.width, picture.height, spec.motion_blur,
                std::numbers::pi * Random(seed, kMotion, view).uniform());
  const glm::vec3 gain = view_gain(spec, seed, view);
  const bool noisy = spec.photon_noise > 0 || spec.read_noise > 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    glm::vec3& light = image[i];
    light *= gain;
    if (noisy) {
      Random random(seed ^ mix_bits(kNoise), view, i + take * image.size());
      for (int c = 0; c < 3; ++c) {
        const double variance = spec.read_noise * spec.read_noise +
                                spec.photon_noise * spec.photon_noise * std::max(0.0f, light[c]);
        light[c] += float(std::sqrt(variance) * random.normal());
      }
    }
    if (spec.code_noise > 0) {
      Random random(seed ^ mix_bits(kCodeNoise), view, i + take * image.size());
      for (int c = 0; c < 3; ++c)
        light[c] = add_code_noise(light[c], spec.code_noise / 255, random);
    }
  }
  return image;
}

}  // namespace

std::vector<std::uint8_t> expose(const Picture& picture, const DegradationSpec& spec,
                                 std::uint64_t seed, std::size_t view, std::uint64_t take) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(picture.colour.size() * 3);
  for (const glm::vec3& light : develop(picture, spec, seed, view, take))
    for (int c = 0; c < 3; ++c) bytes.push_back(encode(light[c]));
  return spec.jpeg > 0 ? through_jpeg(bytes, picture.width, picture.height, spec.jpeg) : bytes;
}

std::vector<std::uint16_t> expose_16_bits(const Picture& picture, const DegradationSpec& spec,
                                          std::uint64_t seed, std::size_t view,
                                          std::uint64_t take) {
  std::vector<std::uint16_t> codes;
  codes.reserve(picture.colour.size() * 3);
  for (const glm::vec3& light : develop(picture, spec, seed, view, take))
    for (int c = 0; c < 3; ++c)
      codes.push_back(
          std::uint16_t(std::lround(65535 * srgb_from_linear(std::clamp(light[c], 0.0f, 1.0f)))));
  return codes;
}

}  // namespace photohull::synth

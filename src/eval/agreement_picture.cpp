#include "eval/agreement_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "eval/error_mesh.h"

namespace photohull::eval {
namespace {

constexpr int kMargin = 12, kTitleHeight = 52, kLeastPanel = 360;
constexpr double kDifference = 0.2;  // of the strongest colours
const glm::dvec3 kBackground(38), kUnlit(190, 40, 170), kUncovered(40, 150, 70),
    kExcess(225, 190, 40), kPlain(70, 80, 100);

glm::dvec3 encode(const glm::vec3& linear) {
  glm::dvec3 out;
  for (int c = 0; c < 3; ++c)
    out[c] = 255 * srgb_from_linear(std::clamp(double(linear[c]), 0.0, 1.0));
  return out;
}

double luminance(const glm::vec3& linear) {
  return 0.2126 * linear.r + 0.7152 * linear.g + 0.0722 * linear.b;
}

/// Rectangle of the pixels that the foreground or the mesh covers, with a margin.
cv::Rect frame_of(const PhotoMaps& maps) {
  const int width = maps.prediction.width, height = maps.prediction.height;
  int x0 = width, y0 = height, x1 = -1, y1 = -1;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(width) + std::size_t(x);
      if (!maps.foreground[i] && maps.prediction.state[i] == PixelState::kMiss) continue;
      x0 = std::min(x0, x), x1 = std::max(x1, x);
      y0 = std::min(y0, y), y1 = std::max(y1, y);
    }
  if (x1 < 0) return {0, 0, width, height};
  x0 = std::max(x0 - kMargin, 0), y0 = std::max(y0 - kMargin, 0);
  x1 = std::min(x1 + kMargin, width - 1), y1 = std::min(y1 + kMargin, height - 1);
  return {x0, y0, x1 - x0 + 1, y1 - y0 + 1};
}

struct PanelColours {
  glm::dvec3 photo, prediction, difference, agreement;
};

PanelColours colours_at(const PreparedView& view, const PhotoMaps& maps, int x, int y) {
  const std::size_t i = std::size_t(y) * std::size_t(maps.prediction.width) + std::size_t(x);
  const PixelState state = maps.prediction.state[i];
  const glm::vec3 photo(view.image.linear(x, y)), predicted(maps.prediction.colour[i]);
  PanelColours c{encode(photo), kBackground, kBackground, kBackground};
  if (state == PixelState::kLit) {
    c.prediction = encode(predicted);
    c.difference = error_colour(
        std::sqrt(luminance(predicted)) - std::sqrt(std::max(luminance(photo), 0.0)), kDifference);
  } else if (state == PixelState::kUnlit) {
    c.prediction = c.difference = kUnlit;
  }
  if (maps.foreground[i] && state == PixelState::kMiss) c.difference = kUncovered;
  if (!maps.foreground[i] && state != PixelState::kMiss) c.difference = kExcess;
  if (maps.foreground[i])
    c.agreement = std::isnan(maps.scores[i])
                      ? kPlain
                      : glm::dvec3(255 * std::clamp(double(maps.scores[i]), 0.0, 1.0));
  return c;
}

void draw_text(cv::Mat& image, const std::string& text, int x, int baseline) {
  cv::putText(image, text, {x, baseline}, cv::FONT_HERSHEY_SIMPLEX, 0.45, cv::Scalar(235, 235, 235),
              1, cv::LINE_AA);
}

}  // namespace

RgbImage draw_agreement(const PreparedView& view, const PhotoMaps& maps, const std::string& title) {
  PHOTOHULL_CHECK_OP(view.image.width, ==, maps.prediction.width);
  PHOTOHULL_CHECK_OP(view.image.height, ==, maps.prediction.height);
  const cv::Rect frame = frame_of(maps);
  const int scale = std::max(1, kLeastPanel / frame.width);
  const cv::Size panel(scale * frame.width, scale * frame.height);
  cv::Mat image(kTitleHeight + panel.height, 4 * panel.width, CV_8UC3, cv::Scalar::all(38));
  for (int y = 0; y < panel.height; ++y)
    for (int x = 0; x < panel.width; ++x) {
      const PanelColours c = colours_at(view, maps, frame.x + x / scale, frame.y + y / scale);
      const glm::dvec3 all[4] = {c.photo, c.prediction, c.difference, c.agreement};
      for (int p = 0; p < 4; ++p)
        image.at<cv::Vec3b>(kTitleHeight + y, p * panel.width + x) = {
            std::uint8_t(std::lround(all[p].r)), std::uint8_t(std::lround(all[p].g)),
            std::uint8_t(std::lround(all[p].b))};
    }
  draw_text(image, title, 8, 18);
  const char* names[4] = {"photograph", "prediction", "difference", "agreement (ZNCC)"};
  for (int p = 0; p < 4; ++p) draw_text(image, names[p], p * panel.width + 8, 42);
  return {image.cols, image.rows,
          std::vector<std::uint8_t>(image.data, image.data + image.total() * 3)};
}

}  // namespace photohull::eval

#include "pipeline/coverage_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "pipeline/box_picture_parts.h"

namespace photohull::pipeline {
namespace {

using namespace picture;

constexpr int kWidth = 1000, kHeight = 900;
constexpr double kRadius = 310;  // pixels, of the outermost circle
const cv::Point2d kZenith(0.5 * kWidth, 450);
constexpr double kDot = 6;  // pixels
const cv::Scalar kGap(60, 140, 255), kPhoto(120, 230, 120), kLost(90, 90, 255);

double degrees(double radians) { return radians * 180 / M_PI; }

/// Where the sky's directions lie in the picture.
class SkyMap {
 public:
  SkyMap(const Coverage& coverage, std::span<const LeftOutPhoto> left_out) {
    double lowest = 0;
    for (const SkyPlace& place : coverage.places) lowest = std::min(lowest, place.elevation);
    for (const LeftOutPhoto& photo : left_out)
      if (photo.place) lowest = std::min(lowest, photo.place->elevation);
    lowest_ = 10 * std::floor(degrees(lowest) / 10 + 1e-6);
  }
  double lowest() const { return lowest_; }  ///< degrees of elevation, at the rim; 0 or less
  double radius(double elevation_degrees) const {
    return kRadius * (90 - elevation_degrees) / (90 - lowest_);
  }
  static cv::Point2d at_radius(double azimuth, double radius) {
    return kZenith + radius * cv::Point2d(std::cos(azimuth), -std::sin(azimuth));
  }
  cv::Point2d at(double azimuth, double elevation) const {
    return at_radius(azimuth, radius(degrees(elevation)));
  }

 private:
  double lowest_ = 0;
};

/// OpenCV's letters are those of ASCII.
std::string plain(const std::string& name) {
  constexpr std::size_t kLongest = 40;
  std::string text;
  for (const char c : name)
    if ((static_cast<unsigned char>(c) & 0xC0) != 0x80) text += c >= ' ' && c <= '~' ? c : '?';
  return text.size() > kLongest ? "..." + text.substr(text.size() - kLongest + 3) : text;
}

void shade_gaps(cv::Mat& picture, const Coverage& coverage) {
  constexpr double kShare = 0.3;
  cv::Mat shaded = picture.clone();
  for (const CoverageGap& gap : coverage.gaps) {
    std::vector<cv::Point> sector{kZenith};
    const int steps = std::max(1, int(gap.degrees()));
    for (int i = 0; i <= steps; ++i)
      sector.emplace_back(SkyMap::at_radius(gap.from + (gap.to - gap.from) * i / steps, kRadius));
    cv::fillPoly(shaded, std::vector{sector}, kGap, cv::LINE_AA);
  }
  cv::addWeighted(shaded, kShare, picture, 1 - kShare, 0, picture);
}

void draw_rings(cv::Mat& picture, const SkyMap& map) {
  const cv::Scalar faint = kPaper + cv::Scalar(50, 50, 50);
  for (int azimuth = 0; azimuth < 360; azimuth += 30) {
    const double a = azimuth * M_PI / 180;
    cv::line(picture, kZenith, SkyMap::at_radius(a, kRadius), faint, 1, cv::LINE_AA);
    const std::string text = concat(azimuth, azimuth == 0 ? " (x)" : "");
    const cv::Size size = text_size(text, 0.4);
    const cv::Point at = SkyMap::at_radius(a, kRadius + 20);
    put_text(picture, text, {at.x - size.width / 2, at.y}, 0.4, kDim);
  }
  for (int elevation = int(map.lowest()); elevation < 90; elevation += elevation % 30 ? 10 : 30) {
    const bool horizon = elevation == 0;
    if (elevation % 30 && elevation != int(map.lowest())) continue;
    cv::circle(picture, kZenith, int(std::lround(map.radius(elevation))), horizon ? kDim : faint,
               horizon ? 2 : 1, cv::LINE_AA);
    put_text(picture, horizon ? "horizon" : concat(elevation),
             SkyMap::at_radius((elevation < 0 ? 45 : 15) * M_PI / 180, map.radius(elevation)), 0.38,
             kDim);
  }
}

void draw_cross(cv::Mat& picture, const cv::Point& at) {
  for (const int s : {-1, 1})
    cv::line(picture, at + cv::Point(-6, -6 * s), at + cv::Point(6, 6 * s), kLost, 2, cv::LINE_AA);
}

void draw_places(cv::Mat& picture, const SkyMap& map, const Coverage& coverage,
                 std::span<const LeftOutPhoto> left_out) {
  for (const SkyPlace& place : coverage.places) {
    const cv::Point at = map.at(place.azimuth, place.elevation);
    cv::circle(picture, at, int(kDot), kPhoto, place.counts ? cv::FILLED : 2, cv::LINE_AA);
  }
  for (const LeftOutPhoto& photo : left_out)
    if (photo.place) draw_cross(picture, map.at(photo.place->azimuth, photo.place->elevation));
}

/// Beside the dots of the photographs that bound gaps, moved apart where they would be on top of
/// each other.
void label_gaps(cv::Mat& picture, const SkyMap& map, const Coverage& coverage) {
  std::vector<cv::Rect> used;  // by dots and texts
  for (const SkyPlace& place : coverage.places) {
    const cv::Point at = map.at(place.azimuth, place.elevation);
    used.emplace_back(at - cv::Point(int(kDot), int(kDot)), cv::Size(2 * int(kDot), 2 * int(kDot)));
  }
  const auto put = [&](const std::string& text, cv::Point at, double size,
                       const cv::Scalar& colour) {
    const cv::Size s = text_size(text, size);
    cv::Rect place(std::clamp(at.x, 0, kWidth - s.width), at.y - s.height / 2, s.width, s.height);
    const auto free = [&] {
      return std::ranges::none_of(used, [&](const cv::Rect& u) { return (u & place).area() > 0; });
    };
    while (!free()) place.y += 5;
    used.push_back(place);
    put_text(picture, text, {place.x, place.y + s.height / 2}, size, colour);
  };
  for (const CoverageGap& gap : coverage.gaps) {
    const double middle = 0.5 * (gap.from + gap.to);
    const std::string text = concat(gap.degrees(), " degrees: photograph here");
    const cv::Point at = SkyMap::at_radius(middle, 0.55 * kRadius);
    put(text, {at.x - text_size(text, 0.55).width / 2, at.y}, 0.55, kInk);
  }
  for (const SkyPlace& place : coverage.places)
    if (std::ranges::any_of(coverage.gaps, [&](const CoverageGap& gap) {
          return gap.before == place.name || gap.after == place.name;
        })) {
      const cv::Point at = map.at(place.azimuth, place.elevation);
      const std::string text = plain(place.name);
      const int wide = text_size(text, 0.45).width, aside = int(2 * kDot);
      const bool left = at.x < kZenith.x;
      put(text, {left ? at.x - aside - wide : at.x + aside, at.y}, 0.45, kInk);
    }
}

void put_title(cv::Mat& picture, const Coverage& coverage) {
  put_text(picture,
           concat("where ", coverage.places.size(),
                  " photographs were taken, as seen from above: straight above in the middle, the "
                  "horizon as a circle"),
           {8, 18}, 0.5);
  const std::string found =
      !coverage.judged ? "they do not look at one place from around it: gaps are not looked for"
      : coverage.gaps.empty() ? "no side of 90 degrees or more is without a photograph"
                              : "shaded: no photograph was taken there";
  put_text(picture, found, {8, 42}, 0.5, coverage.gaps.empty() ? kDim : kGap);
}

void put_left_out(cv::Mat& picture, std::span<const LeftOutPhoto> left_out) {
  constexpr std::size_t kColumns = 3, kRows = 3;
  if (left_out.empty()) return;
  const int top = kHeight - 20 * int(kRows + 1);
  draw_cross(picture, {16, top});
  put_text(picture,
           concat(left_out.size(), left_out.size() == 1 ? " photograph was" : " photographs were",
                  " left out; a cross is where one was taken, as far as that is known:"),
           {28, top}, 0.45, kLost);
  const std::size_t shown =
      left_out.size() <= kColumns * kRows ? left_out.size() : kColumns * kRows - 1;
  for (std::size_t i = 0; i < std::min(left_out.size(), shown + 1); ++i) {
    const std::string text =
        i < shown ? plain(left_out[i].name) : concat("and ", left_out.size() - shown, " more");
    put_text(
        picture, text,
        {28 + int(i % kColumns) * (kWidth / int(kColumns)), top + 20 * (1 + int(i / kColumns))},
        0.42, kInk);
  }
}

}  // namespace

RgbImage draw_coverage(const Coverage& coverage, std::span<const LeftOutPhoto> left_out) {
  cv::Mat picture(kHeight, kWidth, CV_8UC3, kPaper);
  const SkyMap map(coverage, left_out);
  draw_rings(picture, map);
  shade_gaps(picture, coverage);
  draw_places(picture, map, coverage, left_out);
  label_gaps(picture, map, coverage);
  put_title(picture, coverage);
  put_left_out(picture, left_out);
  RgbImage out{kWidth, kHeight, {}};
  cv::Mat rgb;
  cv::cvtColor(picture, rgb, cv::COLOR_BGR2RGB);
  out.rgb.assign(rgb.datastart, rgb.dataend);
  return out;
}

}  // namespace photohull::pipeline

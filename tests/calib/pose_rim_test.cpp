// Photographs of a strip of tags around a cylinder.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "calib/pose_photographs.h"
#include "rendered_boards.h"
#include "sheet/draw_sheet.h"

namespace photohull {
namespace {

using testing::HasSubstr;

constexpr int kViews = 10;

SheetOptions rim_of(double diameter) {
  SheetOptions options;
  options.kind = SheetKind::kRim;
  options.diameter = diameter;
  return options;
}

/// All around the cylinder, from two heights, at a distance in mm.
Pose look_at_rim(int i, double distance) {
  const double azimuth = 2 * std::numbers::pi * i / kViews, elevation = (i % 2 ? 15 : 35) * kRadian;
  const glm::dvec3 eye =
      distance * glm::dvec3(std::cos(elevation) * std::cos(azimuth),
                            std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  const glm::dvec3 forward = glm::normalize(glm::dvec3(5.0 * (i % 3 - 1), 0, 10) - eye);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 0, 1)));
  Pose pose;
  pose.rotation = glm::transpose(glm::dmat3(right, glm::cross(forward, right), forward));
  pose.translation = -(pose.rotation * eye);
  return pose;
}

Truth truth_of(double focal) {
  Truth truth;
  truth.k = {1200, 900, focal, focal, 0, 602.5, 447.5};
  truth.lens = {DistortionModel::kBrown, {-0.05, 0.02, 0, 0}};
  return truth;
}

/// Radians of the circle.
double tag_angle(const Sheet& sheet, const SheetTag& tag) {
  const glm::dvec2 a(sheet.at(tag.corners[0])), b(sheet.at(tag.corners[1]));
  return std::acos(glm::dot(a, b) / glm::dot(a, a));
}

/// Corners of the tags that face the camera, with noise of so many pixels.
PosePhoto exact_photo(const Truth& truth, const Sheet& sheet, int i, double distance,
                      double noise) {
  std::mt19937 random(std::uint32_t(i) + 1);
  std::normal_distribution<double> normal;
  const Pose pose = look_at_rim(i, distance);
  const glm::dvec3 eye = -(glm::transpose(pose.rotation) * pose.translation);
  PosePhoto photo;
  photo.view.board = {concat("p", i), truth.k.width, truth.k.height, {}, {}, 0};
  for (const SheetTag& tag : sheet.tags) {
    const glm::dvec3 middle = sheet.at(0.5 * (tag.corners[0] + tag.corners[2]));
    const glm::dvec3 outwards = glm::normalize(glm::dvec3(middle.x, middle.y, 0));
    if (glm::dot(glm::normalize(eye - middle), outwards) < 0.55) continue;
    photo.view.tags.push_back(tag.id);
    // What find_tags measures: corners of lines through arcs, which bulge by so much.
    const double radius = glm::length(glm::dvec2(middle)), angle = tag_angle(sheet, tag);
    const double bulge = radius * (1 - std::cos(angle / 2)) * (1 - 0.84 * 0.84 / 3);
    const double down = bulge * (eye.z - middle.z) / glm::dot(eye - middle, outwards);
    for (const glm::dvec2& corner : tag.corners) {
      const glm::dvec3 p =
          pose.rotation * (sheet.at(corner) - glm::dvec3(0, 0, down)) + pose.translation;
      const glm::dvec2 q = distort(truth.lens, glm::dvec2(p) / p.z);
      const glm::dvec2 off = noise * glm::dvec2(normal(random), normal(random));
      photo.view.board.points.push_back(sheet.at(corner));
      photo.view.board.pixels.push_back(
          glm::dvec2(truth.k.fx * q.x + truth.k.cx, truth.k.fy * q.y + truth.k.cy) + off);
    }
  }
  return photo;
}

/// Share of the distance, the largest of all photographs.
double place_error(const PoseResult& result, double distance) {
  double error = 0;
  for (int i = 0; i < kViews; ++i) {
    const Pose truth = look_at_rim(i, distance),
               &found = result.photos[std::size_t(i)].cam_from_world;
    error = std::max(error, glm::length(glm::transpose(found.rotation) * found.translation -
                                        glm::transpose(truth.rotation) * truth.translation) /
                                distance);
  }
  return error;
}

TEST(PoseRim, ProjectedCornersGiveTheCamerasWithAndWithoutAFocalLength) {
  const Sheet sheet = make_sheet(rim_of(200));
  const Truth truth = truth_of(1400);
  for (const double stated : {0.0, 1300.0}) {
    std::vector<PosePhoto> photos;
    for (int i = 0; i < kViews; ++i) {
      photos.push_back(exact_photo(truth, sheet, i, 560, 0.05));
      photos.back().focal = stated;
    }
    const PoseResult r = pose_photographs(photos, sheet, {});
    for (const PosedPhoto& photo : r.photos) EXPECT_TRUE(photo.posed) << photo.reason;
    EXPECT_LT(r.rms, 0.1);
    EXPECT_NEAR(r.cameras[0].intrinsics.fx, 1400, 4 * r.cameras[0].focal_sigma) << stated;
    EXPECT_LT(r.cameras[0].focal_sigma, 0.02 * 1400);
    EXPECT_LT(place_error(r, 560), 0.02) << stated;
    EXPECT_FALSE(r.bend.found);
    // Above the strip, as wide as the cylinder.
    EXPECT_NEAR(r.box.min.z, sheet.strip + 1, 1e-9);
    EXPECT_NEAR(r.box.max.x, 100, 1e-9);
  }
}

TEST(PoseRim, PrintsThatAreTooSmallAreToldByTheBar) {
  const Sheet described = make_sheet(rim_of(200)), printed = as_printed(described, 147);
  EXPECT_NEAR(printed.bar_length(), 147, 1e-9);
  EXPECT_NEAR(printed.tags[3].corners[2].x, 0.98 * described.tags[3].corners[2].x, 1e-9);
  EXPECT_THROW(as_printed(described, 15), UsageError);
  std::vector<PosePhoto> photos;
  for (int i = 0; i < kViews; ++i)
    photos.push_back(exact_photo(truth_of(1400), printed, i, 560, 0));
  PoseOptions options;
  options.bar = 147;
  const PoseResult r = pose_photographs(photos, printed, options);
  EXPECT_NEAR(r.scale, 1, 1e-12);
  EXPECT_LT(place_error(r, 560), 0.01);
}

TEST(PoseRim, ATagThatIsTakenForAnotherIsLeftOutAndFewTagsAreTold) {
  const Sheet sheet = make_sheet(rim_of(200));
  std::vector<PosePhoto> photos;
  for (int i = 0; i < kViews; ++i) photos.push_back(exact_photo(truth_of(1400), sheet, i, 560, 0));
  BoardView& wrong = photos[2].view.board;
  std::rotate(wrong.points.begin(), wrong.points.begin() + 4, wrong.points.begin() + 8);
  photos[4].view.tags.resize(2);
  photos[4].view.board.points.resize(8), photos[4].view.board.pixels.resize(8);
  const PoseResult r = pose_photographs(photos, sheet, {});
  EXPECT_TRUE(r.photos[2].posed);
  EXPECT_EQ(r.photos[2].tags_used, r.photos[2].tags_found - 2);
  EXPECT_FALSE(r.photos[4].posed);
  EXPECT_THAT(r.photos[4].reason, HasSubstr("2 tags were found; 3 are needed"));
}

/// Pixels between where points above the strip are seen and where the cameras found have them, root
/// mean square: `height` mm, as wide as half the cylinder.
double object_error(const Truth& truth, const PoseResult& result, double height) {
  double sum = 0, count = 0;
  for (int i = 0; i < kViews; ++i)
    for (const double z : {20.0, 20 + height / 2, 20 + height})
      for (const glm::dvec2& xy : {glm::dvec2(0), {50, 0}, {-50, 0}, {0, 50}, {0, -50}}) {
        const auto seen = [&](const Pose& pose, const Intrinsics& k, const Distortion& lens) {
          const glm::dvec3 p = pose.rotation * glm::dvec3(xy, z) + pose.translation;
          const glm::dvec2 q = distort(lens, glm::dvec2(p) / p.z);
          return glm::dvec2(k.fx * q.x + k.cx, k.fy * q.y + k.cy);
        };
        const PosedCamera& camera = result.cameras[0];
        const glm::dvec2 off = seen(look_at_rim(i, 560), truth.k, truth.lens) -
                               seen(result.photos[std::size_t(i)].cam_from_world, camera.intrinsics,
                                    camera.distortion);
        sum += glm::dot(off, off), ++count;
      }
  return std::sqrt(sum / count);
}

/// How light the cylinder is where a ray meets it, by the pieces that were printed.
double light_of(const Sheet& sheet, const SheetPicture& picture, const glm::dvec3& eye,
                const glm::dvec3& way) {
  const double radius = glm::length(glm::dvec2(sheet.at({0, 0})));
  const glm::dvec2 e(eye), w(way);
  const double a = glm::dot(w, w), b = glm::dot(e, w), c = glm::dot(e, e) - radius * radius;
  const double root = b * b - a * c;
  if (root < 0) return 0.3;
  const glm::dvec2 p = sheet.on_paper(eye + (-b - std::sqrt(root)) / a * way);
  if (p.y < 0 || p.y > sheet.strip) return 0.3;
  for (const StripPiece& piece : sheet.pieces)
    if (p.x >= piece.from && p.x <= piece.to)
      return 0.04 + 0.8 * double(picture.at(piece.low + glm::dvec2(p.x - piece.from, p.y)));
  return 0.3;
}

TEST(PoseRim, RenderedStripsArePosed) {
  const Sheet sheet = make_sheet(rim_of(200));
  const SheetPicture picture = sheet_picture(sheet, 20);
  const Truth truth = truth_of(1400);
  std::vector<PosePhoto> photos;
  for (int i = 0; i < kViews; ++i) {
    const Pose pose = look_at_rim(i, 560);
    const glm::dvec3 eye = -(glm::transpose(pose.rotation) * pose.translation);
    PosePhoto photo;
    photo.view =
        find_tags(photograph(truth, pose,
                             [&](double x, double y) {
                               return light_of(sheet, picture, eye, glm::dvec3(x, y, 0) - eye);
                             }),
                  sheet, concat("view ", i));
    EXPECT_GE(photo.view.tags.size(), 6u);
    EXPECT_EQ(photo.view.foreign, 0);
    photos.push_back(std::move(photo));
  }
  const PoseResult r = pose_photographs(photos, sheet, {});
  for (const PosedPhoto& photo : r.photos) EXPECT_TRUE(photo.posed) << photo.reason;
  RecordProperty("rim_rms", concat(r.rms));
  RecordProperty("rim_focal", concat(r.cameras[0].intrinsics.fx / 1400 - 1));
  RecordProperty("rim_place", concat(place_error(r, 560)));
  RecordProperty("rim_focal_sigma", concat(r.cameras[0].focal_sigma));
  RecordProperty("rim_object_50", concat(object_error(truth, r, 50)));
  RecordProperty("rim_object_100", concat(object_error(truth, r, 100)));
  RecordProperty("rim_object_stated", concat(r.object_error));
  EXPECT_LT(r.rms, 0.1);
  // A small strip tells the distance only together with the focal length.
  EXPECT_NEAR(r.cameras[0].intrinsics.fx, 1400, 0.04 * 1400);
  EXPECT_LT(place_error(r, 560), 0.03);
  EXPECT_LT(object_error(truth, r, 100), 3);
}

}  // namespace
}  // namespace photohull

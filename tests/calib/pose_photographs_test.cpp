#include "calib/pose_photographs.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "io/image_file.h"
#include "rendered_boards.h"
#include "sheet/bend_sheet.h"
#include "sheet/draw_sheet.h"

namespace photohull {
namespace {

using testing::HasSubstr;

constexpr double kReachA4 = 181.865;  // half an A4 page's diagonal, mm

/// Around the sheet, from two heights, upright with some roll.
Pose look_at_sheet_from(int i, int count, double distance) {
  const double azimuth = 2 * std::numbers::pi * i / count, elevation = (i % 2 ? 35 : 60) * kRadian;
  const glm::dvec3 eye =
      distance * glm::dvec3(std::cos(elevation) * std::sin(azimuth),
                            -std::cos(elevation) * std::cos(azimuth), std::sin(elevation));
  const glm::dvec3 target(10.0 * (i % 3 - 1), 8.0 * (i % 5 - 2), 0);
  const glm::dvec3 forward = glm::normalize(target - eye);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 0, 1)));
  const glm::dvec3 down = glm::cross(forward, right);
  const double roll = 0.2 * (i % 4 - 1.5);
  const glm::dvec3 x = std::cos(roll) * right + std::sin(roll) * down;
  Pose pose;
  pose.rotation = glm::transpose(glm::dmat3(x, glm::cross(forward, x), forward));
  pose.translation = -(pose.rotation * eye);
  return pose;
}

Truth truth_of(int width, int height, double focal) {
  Truth truth;
  truth.k = {width, height, focal, focal, 0, (width - 1) / 2.0 + 3, (height - 1) / 2.0 - 2};
  truth.lens = {DistortionModel::kBrown, {-0.08, 0.03, 0.0005, -0.0003}};
  return truth;
}

struct ExactOptions {
  double noise = 0.1;  ///< pixels
  glm::dvec3 bend{0.0};
  double print = 1;
  double hidden = 0.3;
  std::uint32_t seed = 1;
};

/// A photograph's corners, computed. Poses are in millimetres as printed.
PosePhoto exact_photo(const Truth& truth, const Pose& pose, const Sheet& sheet,
                      const std::string& name, const ExactOptions& o) {
  std::mt19937 random(o.seed);
  std::normal_distribution<double> normal(0, o.noise > 0 ? o.noise : 1);
  std::uniform_real_distribution<double> uniform(0, 1);
  PosePhoto photo;
  photo.camera = concat(truth.k.fx);
  photo.view.board = {name, truth.k.width, truth.k.height, {}, {}, 0};
  for (const SheetTag& tag : sheet.tags) {
    if (uniform(random) < o.hidden) continue;
    photo.view.tags.push_back(tag.id);
    for (const glm::dvec2& corner : tag.corners) {
      glm::dvec3 place(corner, 0);
      bend_sheet(&o.bend.x, kReachA4, &place.x);
      const glm::dvec3 p = pose.rotation * (o.print * place) + pose.translation;
      const glm::dvec2 q = distort(truth.lens, glm::dvec2(p) / p.z);
      const glm::dvec2 off =
          o.noise > 0 ? glm::dvec2(normal(random), normal(random)) : glm::dvec2(0);
      photo.view.board.points.emplace_back(corner, 0);
      photo.view.board.pixels.push_back(
          glm::dvec2(truth.k.fx * q.x + truth.k.cx, truth.k.fy * q.y + truth.k.cy) + off);
    }
  }
  return photo;
}

std::vector<PosePhoto> exact_photos(const Truth& truth, const Sheet& sheet, int count,
                                    const ExactOptions& o) {
  std::vector<PosePhoto> photos;
  for (int i = 0; i < count; ++i) {
    ExactOptions own = o;
    own.seed = o.seed + 100 * std::uint32_t(i);
    photos.push_back(
        exact_photo(truth, look_at_sheet_from(i, count, 520), sheet, concat("p", i), own));
  }
  return photos;
}

struct PoseErrors {
  double place = 0, turn = 0;  ///< largest: of the distance; degrees
};

PoseErrors errors_of(const PoseResult& result, int count, double distance, double units_per_mm) {
  PoseErrors e;
  for (int i = 0; i < count; ++i) {
    const Pose truth = look_at_sheet_from(i, count, distance);
    const Pose& found = result.photos[std::size_t(i)].cam_from_world;
    const glm::dmat3 turn = found.rotation * glm::transpose(truth.rotation);
    const glm::dvec3 place = -(glm::transpose(found.rotation) * found.translation) / units_per_mm +
                             glm::transpose(truth.rotation) * truth.translation;
    e.place = std::max(e.place, glm::length(place) / distance);
    const double cosine = (turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2;
    e.turn = std::max(e.turn, std::acos(std::min(1.0, cosine)) / kRadian);
  }
  return e;
}

TEST(PosePhotographs, ExactCornersGiveExactCameras) {
  const Sheet sheet = make_sheet({});
  const Truth truth = truth_of(1600, 1200, 1500);
  const PoseResult r =
      pose_photographs(exact_photos(truth, sheet, 8, {0, glm::dvec3(0.0)}), sheet, {});
  ASSERT_EQ(r.cameras.size(), 1u);
  EXPECT_NEAR(r.cameras[0].intrinsics.fx, 1500, 0.01);
  EXPECT_NEAR(r.cameras[0].distortion.coefficients[0], -0.08, 1e-4);
  EXPECT_LT(r.rms, 1e-3);
  EXPECT_FALSE(r.bend.found);
  const PoseErrors e = errors_of(r, 8, 520, 1);
  EXPECT_LT(e.place, 1e-5);
  EXPECT_LT(e.turn, 1e-3);
  EXPECT_NEAR(r.box.min.x, sheet.free_min.x, 1e-9);
  EXPECT_NEAR(r.box.min.z, 1, 1e-9);
}

TEST(PosePhotographs, DeviationsAreThoseOfTheNoise) {
  const Sheet sheet = make_sheet({});
  const Truth truth = truth_of(1600, 1200, 1500);
  double focal = 0, said = 0, place = 0, place_said = 0;
  constexpr int kDraws = 6, kViews = 10;
  for (std::uint32_t draw = 0; draw < kDraws; ++draw) {
    const PoseResult r = pose_photographs(
        exact_photos(truth, sheet, kViews, {0.2, glm::dvec3(0.0), 1, 0.3, 7 + draw}), sheet, {});
    EXPECT_NEAR(r.rms, 0.2 * std::sqrt(2), 0.04);
    focal += std::pow(r.cameras[0].intrinsics.fx - 1500, 2);
    said += std::pow(r.cameras[0].focal_sigma, 2);
    for (int i = 0; i < kViews; ++i) {
      const Pose t = look_at_sheet_from(i, kViews, 520);
      const glm::dvec3 off = r.photos[std::size_t(i)].cam_from_world.translation - t.translation;
      place += std::pow(std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}), 2);
      place_said += std::pow(r.photos[std::size_t(i)].place_sigma, 2);
    }
  }
  EXPECT_GT(focal, 0.15 * said);
  EXPECT_LT(focal, 4 * said);
  EXPECT_GT(place, 0.4 * place_said);
  EXPECT_LT(place, 2.5 * place_said);
}

TEST(PosePhotographs, BentSheetPrintedTooSmallIsFoundAndTold) {
  const Sheet sheet = make_sheet({});
  const Truth truth = truth_of(1600, 1200, 1500);
  // 5 mm at the upper and lower edge.
  const double rise = 5 / 0.97 * std::pow(kReachA4 / 148.5, 2);
  const auto photos = exact_photos(truth, sheet, 12, {0.1, {0, 0, rise}, 0.97});
  PoseOptions options;
  options.bar = 0.97 * sheet.bar_length();
  const PoseResult r = pose_photographs(photos, sheet, options);
  EXPECT_TRUE(r.bend.found);
  EXPECT_NEAR(r.bend.yy * std::pow(0.97 * (sheet.page.y / 2), 2), 5, 0.1);
  EXPECT_NEAR(r.bend.xx * std::pow(sheet.page.x / 2, 2), 0, 0.1);
  EXPECT_NEAR(r.scale, 0.97, 1e-12);
  // Bend, lens and tilt are hard to tell apart: errors are as large as is said, and not larger.
  const PoseErrors e = errors_of(r, 12, 520, 1);
  double place_sigma = 0, turn_sigma = 0;
  for (const PosedPhoto& photo : r.photos) {
    place_sigma = std::max(place_sigma, photo.place_sigma);
    turn_sigma = std::max(turn_sigma, photo.turn_sigma);
  }
  EXPECT_LT(520 * e.place, 4 * place_sigma);
  EXPECT_LT(e.turn, 4 * turn_sigma);
  EXPECT_LT(e.place, 2e-3);
  const PoseResult exact =
      pose_photographs(exact_photos(truth, sheet, 12, {0, {0, 0, rise}, 0.97}), sheet, options);
  EXPECT_LT(errors_of(exact, 12, 520, 1).place, 1e-4);
  // Taken for flat it fits worse, and the scale without the bar is wrong.
  options.flat = true;
  const PoseResult flat = pose_photographs(photos, sheet, options);
  EXPECT_GT(flat.rms, 3 * r.rms);
  PoseOptions unmeasured;
  EXPECT_NEAR(errors_of(pose_photographs(photos, sheet, unmeasured), 12, 520, 1).place, 0.031,
              0.005);
}

TEST(PosePhotographs, WrongTagsAndMovedSheetsAreLeftOut) {
  const Sheet sheet = make_sheet({});
  const Truth truth = truth_of(1600, 1200, 1500);
  std::vector<PosePhoto> photos = exact_photos(truth, sheet, 10, {});
  // Two tags that are called as others are, as a wrong decision of the detector has it.
  BoardView& wrong = photos[3].view.board;
  for (std::size_t k = 0; k < 4; ++k) {
    std::swap(wrong.points[k], wrong.points[20 + k]);
    wrong.pixels[40 + k] += glm::dvec2(6, -5);
  }
  // A photograph that shows one tag, and one of a torn sheet.
  photos[5].view.tags.resize(1);
  photos[5].view.board.points.resize(4), photos[5].view.board.pixels.resize(4);
  for (std::size_t k = 0; k < photos[7].view.board.pixels.size(); ++k)
    photos[7].view.board.pixels[k] += glm::dvec2(k / 4 % 2 ? 8 : -8, k / 4 % 3 ? 6 : -6);
  const PoseResult r = pose_photographs(photos, sheet, {});
  EXPECT_EQ(r.photos[3].tags_used, r.photos[3].tags_found - 3);
  EXPECT_FALSE(r.photos[5].posed);
  EXPECT_THAT(r.photos[5].reason, HasSubstr("1 tag was found"));
  EXPECT_FALSE(r.photos[7].posed);
  EXPECT_THAT(r.photos[7].reason, HasSubstr("do not fit"));
  EXPECT_LT(r.rms, 0.16);
  EXPECT_NEAR(r.cameras[0].intrinsics.fx, 1500, 1.5);
}

TEST(PosePhotographs, EachZoomHasALensOfItsOwn) {
  const Sheet sheet = make_sheet({});
  std::vector<PosePhoto> photos = exact_photos(truth_of(1600, 1200, 1500), sheet, 8, {});
  for (PosePhoto& photo : exact_photos(truth_of(1600, 1200, 1900), sheet, 8, {}))
    photos.push_back(photo);
  photos.back().focal = 0;
  const PoseResult r = pose_photographs(photos, sheet, {});
  ASSERT_EQ(r.cameras.size(), 2u);
  EXPECT_NEAR(r.cameras[0].intrinsics.fx, 1500, 1.5);
  EXPECT_NEAR(r.cameras[1].intrinsics.fx, 1900, 1.9);
  EXPECT_EQ(r.cameras[1].photographs, 8);
}

TEST(PosePhotographs, AStatedFocalLengthHelpsASingleView) {
  const Sheet sheet = make_sheet({});
  std::vector<PosePhoto> photos = exact_photos(truth_of(1600, 1200, 1500), sheet, 24, {});
  photos.resize(1);
  photos[0].focal = 1530;
  const PoseResult r = pose_photographs(photos, sheet, {});
  EXPECT_TRUE(r.photos[0].posed);
  EXPECT_NEAR(r.cameras[0].intrinsics.fx, 1500, 4 * r.cameras[0].focal_sigma);
  EXPECT_LT(r.cameras[0].focal_sigma, 100);
}

TEST(PosePhotographs, SaysWhyNothingCanBePosed) {
  const Sheet sheet = make_sheet({});
  PosePhoto none;
  none.view.board = {"dark.jpg", 640, 480, {}, {}, 0};
  const auto message = [&](const PosePhoto& photo) {
    try {
      pose_photographs({photo}, sheet, {});
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(message(none), HasSubstr("dark.jpg: no tag was found"));
  none.view.mirrored = true;
  EXPECT_THAT(message(none), HasSubstr("mirrored"));
  none.view.mirrored = false, none.view.foreign = 3;
  EXPECT_THAT(message(none), HasSubstr("3 tags, none of them of this board"));
  PoseOptions wrong;
  wrong.bar = 15;  // centimetres
  EXPECT_THROW(pose_photographs({none}, sheet, wrong), UsageError);
}

/// Photographs rendered by rays: detector, edges and solution together.
void check_rendered(const SheetOptions& kind, double rms_bound) {
  const Sheet sheet = make_sheet(kind);
  const SheetPicture picture = sheet_picture(sheet, 10);
  const Truth truth = truth_of(800, 600, 760);
  constexpr int kViews = 8;
  std::vector<PosePhoto> photos;
  const Pattern pattern = [&](double x, double y) {
    const float light = picture.at({x, y});
    if (light < 0) return 0.3;
    if (std::hypot(x - 20, y + 60) < 75) return 0.25;  // an object of a kind
    return 0.04 + 0.8 * double(light);
  };
  for (int i = 0; i < kViews; ++i) {
    PosePhoto photo;
    photo.view = find_tags(photograph(truth, look_at_sheet_from(i, kViews, 480), pattern), sheet,
                           concat("view ", i));
    EXPECT_GE(photo.view.tags.size(), 12u);
    photos.push_back(std::move(photo));
  }
  const PoseResult r = pose_photographs(photos, sheet, {});
  const PoseErrors e = errors_of(r, kViews, 480, 1);
  ::testing::Test::RecordProperty(sheet.kind + "_rms", concat(r.rms));
  ::testing::Test::RecordProperty(sheet.kind + "_focal",
                                  concat(r.cameras[0].intrinsics.fx / 760 - 1));
  ::testing::Test::RecordProperty(sheet.kind + "_place", concat(e.place));
  ::testing::Test::RecordProperty(sheet.kind + "_turn", concat(e.turn));
  EXPECT_LT(r.rms, rms_bound);
  EXPECT_NEAR(r.cameras[0].intrinsics.fx, 760, 0.001 * 760);
  EXPECT_LT(e.place, 5e-4);
  EXPECT_LT(e.turn, 0.03);
  EXPECT_FALSE(r.bend.found);
  for (const PosedPhoto& photo : r.photos) EXPECT_TRUE(photo.posed) << photo.reason;
}

TEST(PosePhotographs, RenderedTagsArePrecise) { check_rendered({}, 0.1); }

TEST(PosePhotographs, RenderedChessboardsArePrecise) {
  check_rendered({Paper::kA4, SheetKind::kCharuco}, 0.12);
}

TEST(FindTags, MirroredPhotographsAreRecognised) {
  const Sheet sheet = make_sheet({});
  const SheetPicture picture = sheet_picture(sheet, 5);
  const Truth truth = truth_of(640, 480, 600);
  const ColourImage image =
      photograph(truth, look_at_sheet_from(1, 8, 480), [&](double x, double y) {
        const float light = picture.at({-x, y});
        return light < 0 ? 0.3 : 0.05 + 0.8 * double(light);
      });
  const SheetView view = find_tags(image, sheet, "mirrored");
  EXPECT_TRUE(view.tags.empty());
  EXPECT_TRUE(view.mirrored);
}

/// A photograph of a chessboard of 5 x 7 squares with markers, from OpenCV's manual (Debian's
/// package opencv-doc).
TEST(FindTags, ARealPhotographIsPosed) {
  const std::filesystem::path file = "/usr/share/doc/opencv-doc/opencv4/html/choriginal.jpg";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the package opencv-doc is not installed";
  const auto board = cv::aruco::CharucoBoard::create(
      5, 7, 40, 20, cv::aruco::getPredefinedDictionary(cv::aruco::DICT_6X6_250));
  Sheet sheet = make_sheet({});
  sheet.dictionary = "aruco-6x6-250";
  sheet.tags.clear(), sheet.squares.clear(), sheet.saddles.clear();
  for (std::size_t i = 0; i < board->ids.size(); ++i) {
    SheetTag tag{board->ids[i], {}};
    for (std::size_t k = 0; k < 4; ++k)
      tag.corners[k] = {double(board->objPoints[i][k].x), double(board->objPoints[i][k].y)};
    sheet.tags.push_back(tag);
  }
  PosePhoto photo;
  photo.view = find_tags(io::read_image(file), sheet, "choriginal.jpg");
  EXPECT_GE(photo.view.tags.size(), 8u);
  PoseOptions options;
  options.flat = true;
  const PoseResult r = pose_photographs({photo}, sheet, options);
  EXPECT_TRUE(r.photos[0].posed);
  EXPECT_LT(r.rms, 0.4);
  ::testing::Test::RecordProperty("real_tags", photo.view.tags.size());
  ::testing::Test::RecordProperty("real_rms", concat(r.rms));
}

}  // namespace
}  // namespace photohull

// Passes of one object joined: exact features with noise, wrong ones among them.
#include "cameras/join_passes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "cameras/pass_points.h"
#include "cameras/refine_motion.h"
#include "core/error.h"

namespace photohull {
namespace {

using testing::HasSubstr;

RigidMotion known_motion() {
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1), 1.7, glm::normalize(glm::dvec3(1, 0.2, -0.4)));
  return {glm::dmat3(turn), {12, -3, 40}};
}

double degrees_between(const glm::dmat3& a, const glm::dmat3& b) {
  const glm::dmat3 r = a * glm::transpose(b);
  const glm::dvec3 axis(r[1][2] - r[2][1], r[2][0] - r[0][2], r[0][1] - r[1][0]);
  return glm::degrees(std::atan2(glm::length(axis), r[0][0] + r[1][1] + r[2][2] - 1));
}

class Randomly {
 public:
  double uniform(double low, double high) {
    return low + (high - low) * double(engine_()) / double(std::mt19937::max());
  }
  double normal() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += uniform(0, 1);
    return sum;
  }
  glm::dvec3 place() { return {uniform(-40, 40), uniform(-40, 40), uniform(0, 80)}; }
  glm::dvec3 noise(double size) { return size * glm::dvec3(normal(), normal(), normal()); }

 private:
  std::mt19937 engine_{7};
};

std::vector<PointPair> right_pairs(int count, Randomly& random) {
  const RigidMotion motion = known_motion();
  std::vector<PointPair> pairs;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 place = random.place();
    pairs.push_back({place, motion(place) + random.noise(0.2), 1.0});
  }
  return pairs;
}

void add_wrong(int count, Randomly& random, std::vector<PointPair>& pairs) {
  for (int i = 0; i < count; ++i) pairs.push_back({random.place(), random.place(), 1.0});
}

TEST(RigidMotion, IsFoundAmongManyWrongPairs) {
  Randomly random;
  std::vector<PointPair> pairs = right_pairs(40, random);
  add_wrong(600, random, pairs);
  const auto found = find_motion(pairs, 12);
  ASSERT_TRUE(found);
  EXPECT_GE(found->agreeing.size(), 38u);
  EXPECT_LE(found->agreeing.size(), 42u);
  EXPECT_LT(degrees_between(found->motion.rotation, known_motion().rotation), 0.2);
  EXPECT_LT(glm::distance(found->motion({0, 0, 40}), known_motion()({0, 0, 40})), 0.2);
  // The inverse, and a moved camera, lead where they should.
  const glm::dvec3 place(3, 5, 7);
  EXPECT_LT(glm::distance(found->motion.inverse()(found->motion(place)), place), 1e-9);
  Camera camera;
  camera.cam_from_world = {known_motion().rotation, {0, 0, 300}};
  EXPECT_LT(glm::distance(found->motion.moved(camera).to_camera(found->motion(place)),
                          camera.to_camera(place)),
            1e-9);
}

TEST(RigidMotion, OfAnotherObjectIsNotFound) {
  Randomly random;
  std::vector<PointPair> pairs;
  EXPECT_FALSE(find_motion(pairs, 12));  // no matches at all
  add_wrong(600, random, pairs);
  EXPECT_FALSE(find_motion(pairs, 12));
  // A few that fit are not enough.
  const std::vector<PointPair> few = right_pairs(8, random);
  pairs.insert(pairs.end(), few.begin(), few.end());
  EXPECT_FALSE(find_motion(pairs, 12));
}

TEST(RigidMotion, OfPointsOnALineIsOpen) {
  Randomly random;
  std::vector<PointPair> pairs;
  for (int i = 0; i < 60; ++i) {
    const glm::dvec3 place =
        glm::dvec3(1, 2, 3) + random.uniform(-40, 40) * glm::dvec3(0, 0.6, 0.8);
    pairs.push_back({place, known_motion()(place) + random.noise(0.2), 1.0});
  }
  EXPECT_FALSE(find_motion(pairs, 12));
}

/// `count` points with descriptors of their own, the same for the same seed.
DescribedPoints described(int count, unsigned seed, const std::vector<glm::dvec3>& places,
                          double noise, Randomly& random) {
  DescribedPoints points;
  for (int i = 0; i < count; ++i) {
    points.places.push_back(places[std::size_t(i)]);
    points.tolerances.push_back(0.5);
    std::mt19937 engine(seed + unsigned(i));
    cv::Mat row(1, 128, CV_32F);
    for (int k = 0; k < 128; ++k)
      row.at<float>(k) =
          float(double(engine()) / double(std::mt19937::max()) * double(engine() % 4 == 0) +
                noise * random.normal());
    points.descriptors.push_back(cv::Mat(row / cv::norm(row)));
    points.owners.push_back(i);
  }
  return points;
}

std::vector<glm::dvec3> places(int count, Randomly& random) {
  std::vector<glm::dvec3> all;
  for (int i = 0; i < count; ++i) all.push_back(random.place());
  return all;
}

std::vector<glm::dvec3> moved(std::vector<glm::dvec3> all) {
  for (glm::dvec3& p : all) p = known_motion()(p);
  return all;
}

TEST(MatchPoints, FindsWhatLooksAlikeAndTheMotion) {
  Randomly random;
  const auto from = places(200, random);
  const DescribedPoints a = described(200, 1, from, 0.03, random),
                        b = described(200, 1, moved(from), 0.03, random);
  const auto pairs = match_points(a, b);
  EXPECT_GT(pairs.size(), 190u);
  const auto found = find_motion(pairs, 12);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->agreeing.size(), pairs.size());
  EXPECT_LT(degrees_between(found->motion.rotation, known_motion().rotation), 1e-6);
}

TEST(MatchPoints, OfAnotherObjectGivesNoMotion) {
  Randomly random;
  const auto from = places(200, random);
  const DescribedPoints a = described(200, 1, from, 0.03, random),
                        b = described(200, 5000, moved(from), 0.03, random);
  EXPECT_FALSE(find_motion(match_points(a, b), 12));
}

TEST(MatchPoints, WhatLooksAlikeInTwoPlacesIsNoMatch) {
  Randomly random;
  const auto from = places(40, random);
  const DescribedPoints a = described(40, 1, from, 0.01, random);
  DescribedPoints twice = described(40, 1, moved(from), 0, random);
  RigidMotion away;
  away.translation = {500, 0, 0};
  twice.add(described(40, 1, moved(from), 0, random), away);
  EXPECT_TRUE(match_points(a, twice).empty());
  // The same point twice does not compete with itself.
  DescribedPoints same = described(40, 1, moved(from), 0.01, random);
  same.add(described(40, 1, moved(from), 0.01, random), {});
  EXPECT_GT(match_points(a, same).size(), 35u);
}

TEST(MatchPoints, OfNothingAreNone) {
  Randomly random;
  const DescribedPoints some = described(40, 1, places(40, random), 0.01, random);
  EXPECT_TRUE(match_points(some, {}).empty());
  EXPECT_TRUE(match_points({}, some).empty());
}

/// Cameras around a place, at a height, that look at it.
std::vector<Camera> ring(int count, const glm::dvec3& middle) {
  std::vector<Camera> cameras;
  for (int i = 0; i < count; ++i) {
    const double turn = 2 * M_PI * i / count;
    const glm::dvec3 eye = middle + glm::dvec3(300 * std::cos(turn), 300 * std::sin(turn), 200);
    const glm::dvec3 forward = glm::normalize(middle - eye),
                     right = glm::normalize(glm::cross(forward, glm::dvec3(0, 0, 1)));
    Camera camera;
    camera.intrinsics = {800, 600, 1000, 1000, 0, 400, 300};
    camera.cam_from_world.rotation =
        glm::transpose(glm::dmat3(right, glm::cross(forward, right), forward));
    camera.cam_from_world.translation = -(camera.cam_from_world.rotation * eye);
    cameras.push_back(camera);
  }
  return cameras;
}

/// Points of an object that each pass shows in three of its views, with noise; the object of the
/// second pass goes to that of the first by known_motion.
struct TwoPasses {
  std::vector<Camera> cameras;
  std::vector<Track> tracks;
  std::size_t seam = 8;

  TwoPasses(const std::vector<glm::dvec3>& points, double noise, Randomly& random) {
    const glm::dvec3 middle(0, 0, 40);
    cameras = ring(8, known_motion()(middle));
    const std::vector<Camera> second = ring(8, middle);
    cameras.insert(cameras.end(), second.begin(), second.end());
    for (std::size_t i = 0; i < points.size(); ++i) {
      Track track;
      for (const std::size_t view :
           {i % 6, i % 6 + 1, i % 6 + 2, 8 + i % 5, 9 + i % 5, 10 + i % 5}) {
        const glm::dvec3 place = view < seam ? known_motion()(points[i]) : points[i];
        const glm::dvec2 off(noise * random.normal(), noise * random.normal());
        track.observations.push_back({int(view), *cameras[view].project(place) + off});
      }
      tracks.push_back(track);
    }
  }

  /// Each camera looks by so many radians (standard deviation, each axis) beside where it did.
  void shake(double angle, Randomly& random) {
    for (Camera& camera : cameras) {
      glm::dmat4 turn(1);
      for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 about(0);
        about[axis] = 1;
        turn = glm::rotate(turn, angle * random.normal(), about);
      }
      Pose& pose = camera.cam_from_world;
      pose.rotation = glm::dmat3(turn) * pose.rotation;
      pose.translation = glm::dmat3(turn) * pose.translation;
    }
  }

  std::optional<RefinedMotion> refine(double turn, double shift) const {
    RigidMotion start = known_motion();
    start.rotation =
        glm::dmat3(glm::rotate(glm::dmat4(1), turn, glm::dvec3(0.6, 0, 0.8))) * start.rotation;
    start.translation += glm::dvec3(shift, -shift, shift);
    return refine_motion({cameras, seam, tracks, start, middle()});
  }
  static glm::dvec3 middle() { return known_motion()({0, 0, 40}); }
};

/// Squares of errors beside the variances that the fits state, over many draws.
class ErrorsByDeviations {
 public:
  void add(const RefinedMotion& refined) {
    const auto& c = refined.covariance;
    const double turn = degrees_between(refined.motion.rotation, known_motion().rotation);
    turn_ += std::pow(turn, 2);
    stated_turn_ += std::pow(180 / M_PI, 2) * (c[0][0] + c[1][1] + c[2][2]);
    const glm::dvec3 off = refined.motion({0, 0, 40}) - TwoPasses::middle();
    shift_ += glm::dot(off, off);
    stated_shift_ += c[3][3] + c[4][4] + c[5][5];
  }
  void expect_alike() const {
    EXPECT_GT(turn_ / stated_turn_, 0.4);
    EXPECT_LT(turn_ / stated_turn_, 2);
    EXPECT_GT(shift_ / stated_shift_, 0.4);
    EXPECT_LT(shift_ / stated_shift_, 2);
  }

 private:
  double turn_ = 0, stated_turn_ = 0, shift_ = 0, stated_shift_ = 0;
};

TEST(RefineMotion, IsExactWithoutNoiseAndAsPreciseAsItSaysWithIt) {
  Randomly random;
  const auto exact = TwoPasses(places(100, random), 0, random).refine(0.02, 1);
  ASSERT_TRUE(exact);
  EXPECT_LT(degrees_between(exact->motion.rotation, known_motion().rotation), 1e-4);
  ErrorsByDeviations of_draws;
  for (int draw = 0; draw < 20; ++draw) {
    const auto refined = TwoPasses(places(100, random), 0.2, random).refine(0.02, 1);
    ASSERT_TRUE(refined);
    EXPECT_GE(refined->points.size(), 95u);
    // Two coordinates' noise, that of the prediction from three other views with it.
    EXPECT_GT(refined->seam, 0.15);
    EXPECT_LT(refined->seam, 0.5);
    of_draws.add(*refined);
  }
  of_draws.expect_alike();
}

TEST(RefineMotion, IsAsPreciseAsItSaysWithCamerasThatAreOff) {
  Randomly random;
  ErrorsByDeviations of_draws;
  for (int draw = 0; draw < 20; ++draw) {
    TwoPasses passes(places(100, random), 0.1, random);
    passes.shake(0.0003, random);  // 0.3 pixels
    const auto refined = passes.refine(0.02, 1);
    ASSERT_TRUE(refined);
    of_draws.add(*refined);
  }
  of_draws.expect_alike();
}

TEST(RefineMotion, LeavesWrongTracksOut) {
  Randomly random;
  TwoPasses passes(places(120, random), 0.1, random);
  for (std::size_t i = 0; i < 24; ++i)
    for (Observation& o : passes.tracks[i].observations)
      if (std::size_t(o.view) < passes.seam) o.pixel += glm::dvec2(5 + double(i), 3);
  const auto refined = passes.refine(0.01, 0.5);
  ASSERT_TRUE(refined);
  EXPECT_GE(refined->points.size(), 90u);
  EXPECT_LE(refined->points.size(), 98u);
  EXPECT_LT(degrees_between(refined->motion.rotation, known_motion().rotation), 0.03);
}

TEST(RefineMotion, OfPointsOnALineSaysThatItIsOpen) {
  Randomly random;
  std::vector<glm::dvec3> line;
  for (int i = 0; i < 60; ++i)
    line.push_back(glm::dvec3(1, 2, 40) + random.uniform(-40, 40) * glm::dvec3(0, 0.6, 0.8));
  const auto refined = TwoPasses(line, 0.1, random).refine(0.001, 0.05);
  ASSERT_TRUE(refined);
  // Beside the line nothing holds.
  EXPECT_GT(deviation_at(*refined, TwoPasses::middle(), known_motion()({40, 0, 40})), 1);
}

TEST(RefineMotion, NeedsTracksAcrossTheSeam) {
  Randomly random;
  TwoPasses passes(places(60, random), 0.1, random);
  for (Track& track : passes.tracks) track.observations.resize(3);
  EXPECT_FALSE(passes.refine(0, 0));
  passes.tracks.clear();
  EXPECT_FALSE(passes.refine(0, 0));
}

/// Grey photographs of a ring.
PhotoPass plain_pass(const std::string& name, int count) {
  PhotoPass pass{name, {}, {glm::dvec3(-50), glm::dvec3(50)}};
  for (const Camera& camera : ring(count, glm::dvec3(0))) {
    PreparedView view;
    view.name = concat(name, "/", pass.views.size());
    view.camera = camera;
    const std::size_t pixels = 800 * 600;
    view.image = {800, 600, ColourImage::Encoding::kSrgb8, false, {}};
    view.image.bytes.assign(4 * pixels, 128);
    view.mask = {800, 600, std::vector<std::uint8_t>(pixels, 255)};
    pass.views.push_back(std::move(view));
  }
  return pass;
}

std::string refusal(const std::vector<PhotoPass>& passes) {
  Progress silent;
  try {
    join_passes(passes, silent);
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

TEST(JoinPasses, OfTooFewPhotographsIsNamed) {
  EXPECT_EQ(refusal({plain_pass("side1", 3), plain_pass("side2", 2)}),
            "side2: 2 photographs have a pose and a mask, and joining passes takes 3 or more, from "
            "all around the object");
  EXPECT_THAT(refusal({plain_pass("side1", 1), plain_pass("side2", 3)}),
              HasSubstr("side1: 1 photograph has"));
}

TEST(JoinPasses, WithoutTextureIsNamed) {
  const std::string said = refusal({plain_pass("side1", 3), plain_pass("side2", 3)});
  EXPECT_THAT(said, HasSubstr("side1: only 0 points of the object can be told apart"));
  EXPECT_THAT(said, HasSubstr("stick or draw small marks onto it"));
}

}  // namespace
}  // namespace photohull

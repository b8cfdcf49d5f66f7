// Edges of tags that something lies over.
#include "calib/tag_edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace photohull {
namespace {

constexpr int kSize = 120, kCells = 10;
const std::array<glm::dvec2, 4> kCorners{
    {{30.4, 33.8}, {88.1, 28.3}, {92.6, 86.9}, {27.2, 90.5}}};  // clockwise in the picture

bool in_square(const glm::dvec2& p) {
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec2 along = kCorners[(i + 1) % 4] - kCorners[i], to = p - kCorners[i];
    if (along.x * to.y - along.y * to.x < 0) return false;
  }
  return true;
}

/// A black square on paper, and a grey disc over both, by 8 x 8 samples a pixel.
cv::Mat draw(const glm::dvec2& middle, double radius) {
  constexpr int kSamples = 8;
  cv::Mat picture(kSize, kSize, CV_32F);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      double sum = 0;
      for (int s = 0; s < kSamples * kSamples; ++s) {
        const glm::dvec2 p(x + (s % kSamples + 0.5) / kSamples - 0.5,
                           y + (s / kSamples + 0.5) / kSamples - 0.5);
        const bool covered = glm::dot(p - middle, p - middle) < radius * radius;
        sum += covered ? 0.3 : in_square(p) ? 0.03 : 0.8;
      }
      picture.at<float>(y, x) = float(sum / (kSamples * kSamples));
    }
  return picture;
}

double off(const MeasuredTag& tag) {
  double most = 0;
  for (std::size_t i = 0; i < 4; ++i)
    most = std::max(most, glm::length(tag.corners[i] - kCorners[i]));
  return most;
}

TEST(TagEdges, LieWhereTheyWereDrawn) {
  const auto tag = measure_tag(draw({-100, -100}, 1), kCorners, kCells);
  ASSERT_TRUE(tag);
  EXPECT_LT(off(*tag), 0.02);
}

// A disc that moves along an edge: the tag is left out, or its corners are right.
TEST(TagEdges, AreNotMovedByWhatCoversThem) {
  int measured = 0, left_out = 0;
  for (const double radius : {4.0, 9.0, 20.0})
    for (const double inwards : {-0.7, 0.0, 0.7})
      for (double along = -0.1; along <= 1.1; along += 0.1) {
        const glm::dvec2 edge = kCorners[1] - kCorners[0], inward(-edge.y, edge.x);
        const glm::dvec2 middle =
            kCorners[0] + along * edge + inwards * radius * glm::normalize(inward);
        const auto tag = measure_tag(draw(middle, radius), kCorners, kCells);
        ++(tag ? measured : left_out);
        if (tag) EXPECT_LT(off(*tag), 0.25) << radius << ' ' << inwards << ' ' << along;
      }
  EXPECT_GT(measured, 20);
  EXPECT_GT(left_out, 20);
}

}  // namespace
}  // namespace photohull

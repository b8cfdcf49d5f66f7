#include "photo/opencv_threads.h"

#include <gtest/gtest.h>

#include <opencv2/core/utility.hpp>

namespace photohull {
namespace {

TEST(OneOpenCvThread, HoldsWhileItLives) {
  cv::setNumThreads(2);
  {
    const OneOpenCvThread outer;
    EXPECT_EQ(cv::getNumThreads(), 1);
    { const OneOpenCvThread inner; }
    EXPECT_EQ(cv::getNumThreads(), 1);
  }
  EXPECT_EQ(cv::getNumThreads(), 2);
}

}  // namespace
}  // namespace photohull

#include "photo/opencv_threads.h"

#include <opencv2/core/utility.hpp>

namespace photohull {

OneOpenCvThread::OneOpenCvThread() : before_(cv::getNumThreads()) { cv::setNumThreads(1); }

OneOpenCvThread::~OneOpenCvThread() { cv::setNumThreads(before_); }

}  // namespace photohull

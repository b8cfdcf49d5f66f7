// How many threads OpenCV may use.
#pragma once

namespace photohull {

/// While it lives, OpenCV works on the thread that calls it. Views are worked on side by side, on
/// as many threads as the caller allows; OpenCV's own would come on top of these. Concerns the
/// whole process.
class OneOpenCvThread {
 public:
  OneOpenCvThread();
  ~OneOpenCvThread();
  OneOpenCvThread(const OneOpenCvThread&) = delete;
  OneOpenCvThread& operator=(const OneOpenCvThread&) = delete;

 private:
  int before_;
};

}  // namespace photohull

// How many threads OpenCV may use.
#pragma once

namespace photohull {

/// While it lives, OpenCV works on the thread that calls it: views are worked on side by side, and
/// threads of its own would wait for one another, busily, and be bounded by no option.
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

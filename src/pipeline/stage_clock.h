// Times the stages of a job and announces them.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "core/progress.h"

namespace photohull::pipeline {

struct StageTime {
  std::string name;
  double wall_seconds = 0;
  double cpu_seconds = 0;              ///< user + system, all threads
  std::int64_t samples = 0;            ///< texture samples, where the stage takes any
  std::int64_t peak_memory_bytes = 0;  ///< of the process up to the stage's end
};

/// User + system seconds of the process so far, all threads.
double process_cpu_seconds();
/// Largest resident set of the process so far.
std::int64_t process_peak_memory();
/// From now on the peak is that of what comes, where the system can do that.
void forget_peak_memory();

class StageClock {
 public:
  explicit StageClock(Progress& progress) : progress_(progress) {}

  /// Runs `work` as the stage `name`, whose expected share of the job is `weight`.
  template <typename F>
  auto run(const std::string& name, double weight, F&& work) {
    progress_.check_cancelled();
    progress_.stage(name, weight);
    const Span span(stages_, name);
    return work();
  }

  const std::vector<StageTime>& stages() const { return stages_; }
  /// Notes the texture samples that a stage took, after it has ended.
  void count_samples(const std::string& name, std::int64_t samples) {
    for (StageTime& stage : stages_)
      if (stage.name == name) stage.samples = samples;
  }

 private:
  /// Notes the time from its construction to its end, whatever the work's result type is.
  struct Span {
    Span(std::vector<StageTime>& all, const std::string& name)
        : stages(all),
          stage{name},
          cpu(process_cpu_seconds()),
          wall(std::chrono::steady_clock::now()) {}
    ~Span() {
      const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - wall;
      stage.wall_seconds = elapsed.count();
      stage.cpu_seconds = process_cpu_seconds() - cpu;
      stage.peak_memory_bytes = process_peak_memory();
      stages.push_back(stage);
    }
    std::vector<StageTime>& stages;
    StageTime stage;
    double cpu;
    std::chrono::steady_clock::time_point wall;
  };
  Progress& progress_;
  std::vector<StageTime> stages_;
};

}  // namespace photohull::pipeline

// Times the stages of a job and announces them.
#pragma once

#include <chrono>

#include "core/progress.h"
#include "pipeline/report.h"

namespace photohull::pipeline {

class StageClock {
 public:
  StageClock(Report& report, Progress& progress) : report_(report), progress_(progress) {}

  /// Runs `work` as the stage `name`, whose expected share of the job is `weight`.
  template <typename F>
  auto run(const std::string& name, double weight, F&& work) {
    progress_.check_cancelled();
    progress_.stage(name, weight);
    const Span span(report_, name);
    return work();
  }

 private:
  /// Notes the time from its construction to its end, whatever the work's result type is.
  struct Span {
    Span(Report& r, const std::string& name)
        : report(r),
          stage{name},
          cpu(process_cpu_seconds()),
          wall(std::chrono::steady_clock::now()) {}
    ~Span() {
      const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - wall;
      stage.wall_seconds = elapsed.count();
      stage.cpu_seconds = process_cpu_seconds() - cpu;
      stage.peak_memory_bytes = process_peak_memory();
      report.stages.push_back(stage);
    }
    Report& report;
    StageReport stage;
    double cpu;
    std::chrono::steady_clock::time_point wall;
  };
  Report& report_;
  Progress& progress_;
};

}  // namespace photohull::pipeline

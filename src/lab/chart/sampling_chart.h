// Errors of samplers against the size of what they sample.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lab/chart/chart_set.h"

namespace photohull::chart {

struct SamplingCurve {
  std::string name;
  std::string like;  ///< curve whose colour and marker it has, dashed; empty: its own
  std::vector<std::pair<double, double>>
      points;  ///< footprint in pixels, error in percent; positive
};

struct SamplingPanel {
  std::string name;  ///< "4 : 1"
  std::vector<SamplingCurve> curves;
};

/// What the axes of panels show.
struct PanelAxes {
  std::string x = "footprint (pixels)", y = "RMS error (% of full scale)";
  double mark = 1;  ///< on y, where a line is drawn
  std::string mark_name = "1 %";
};

/// Panels side by side, log-log, with a line at one percent. A curve of one name looks the same in
/// all.
Chart sampling_chart(const std::string& title, const std::vector<SamplingPanel>& panels,
                     const PanelAxes& axes = {});

}  // namespace photohull::chart

// The charts and their figures as one HTML page.
#pragma once

#include <string>
#include <vector>

#include "lab/chart/chart_set.h"

namespace photohull::chart {

struct PageParts {
  std::string title;
  std::vector<std::string> notes;  ///< plain text
  std::vector<Chart> charts;
  std::string choice;   ///< what the groups of charts are: "Scene"
  std::string caption;  ///< above the table; HTML
  std::string table;    ///< HTML; its id is "results", and the first three columns are texts
};

/// A page that needs nothing else: ECharts, charts with values to point at, and a table. It loads
/// nothing from anywhere.
std::string make_page(const PageParts& parts);

/// The page of charts of outcomes, with a table of all of them, failed ones marked.
std::string make_page(const std::string& title, const std::vector<std::string>& notes,
                      const std::vector<Chart>& charts, const std::vector<Outcome>& outcomes,
                      double threshold_percent);

}  // namespace photohull::chart

#include "lab/chart/chart_files.h"

#include <algorithm>

#include "core/atomic_file.h"
#include "lab/chart/png.h"
#include "lab/chart/svg_renderer.h"

namespace photohull::chart {

namespace fs = std::filesystem;
constexpr int kPngScale = 2;

std::vector<std::string> write_chart_files(const std::vector<Chart>& charts, const fs::path& folder,
                                           Progress& progress) {
  SvgRenderer renderer;
  std::vector<std::string> files;
  for (std::size_t i = 0; i < charts.size(); ++i) {
    progress.check_cancelled();
    progress.update(double(i) / double(charts.size()));
    const Chart& c = charts[i];
    const std::string svg = renderer.render(c.option, c.width, c.height);
    write_atomically(folder / (c.id + ".svg"), svg);
    write_png(svg, kPngScale * c.width, kPngScale * c.height, folder / (c.id + ".png"));
    files.push_back(c.id + ".svg");
    files.push_back(c.id + ".png");
  }
  return files;
}

void remove_stale_charts(const fs::path& folder, const std::vector<std::string>& files) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool chart =
        name.find("--") != std::string::npos && (name.ends_with(".svg") || name.ends_with(".png"));
    std::error_code ignored;
    if (chart && std::find(files.begin(), files.end(), name) == files.end())
      fs::remove(entry.path(), ignored);
  }
}

}  // namespace photohull::chart

#include "texture/paint_page.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <vector>

#include "texture/canvas.h"
#include "texture/spread_colours.h"
#include "texture/surface.h"

namespace photohull::texture {
namespace {

constexpr float kCodes = 65535;

/// A canvas, and the photographs that show anything of it.
struct Work {
  Canvas canvas;
  std::vector<std::uint8_t> shown;  // by each view
};

class Painter {
 public:
  Painter(const Paint& paint, const PagePlan& plan)
      : paint_(paint), plan_(plan), roots_(std::size_t(plan.size().x) * plan.size().y) {}

  /// Charts of the page from the one at `first` on, as many as are painted at a time; returns the
  /// first that is left.
  std::size_t paint_some(std::size_t first, Progress& progress) {
    std::int64_t texels = 0;
    std::size_t end = first;
    for (; end < plan_.charts().size(); ++end) {
      const glm::ivec2& size = paint_.charts[plan_.charts()[end]].size;
      const std::int64_t more = std::int64_t(size.x) * size.y;
      if (end > first && texels + more > paint_.canvas_texels) break;
      texels += more;
    }
    most_at_once_ = std::max(most_at_once_, texels);
    std::vector<std::unique_ptr<Work>> works(end - first);
    tbb::parallel_for(std::size_t(0), works.size(),
                      [&](std::size_t i) { works[i] = begin(plan_.charts()[first + i]); });
    take_own(works, progress);
    for (std::size_t v = 0; v < paint_.sources.size(); v += kSourcesAtOnce)
      add_views(works, v, std::min(v + kSourcesAtOnce, paint_.sources.size()), progress);
    tbb::parallel_for(std::size_t(0), works.size(), [&](std::size_t i) { finish(*works[i]); });
    return end;
  }

  PaintedPage finish() const {
    PaintedPage out{{plan_.size().x, plan_.size().y, {}}, texels_, filled_, most_at_once_};
    std::vector<std::uint8_t> shown(roots_.size());
    out.page.rgb.resize(3 * roots_.size());
    for (int y = 0; y < plan_.size().y; ++y)
      for (int x = 0; x < plan_.size().x; ++x) {
        const std::size_t i = plan_.index({x, y});
        shown[i] = plan_.face({x, y}) != kNoFace;
        for (std::size_t c = 0; c < 3; ++c) {
          const double root = roots_[i][c] / kCodes;
          out.page.rgb[3 * i + c] =
              shown[i] ? std::uint8_t(std::lround(255 * srgb_from_linear(root * root))) : 0;
        }
      }
    spread_colours(shown, out.page);
    return out;
  }

 private:
  std::unique_ptr<Work> begin(std::uint32_t chart_index) const {
    const Chart& chart = paint_.charts[chart_index];
    auto work =
        std::make_unique<Work>(Work{Canvas(paint_.mesh, paint_.planes, chart, chart_index, plan_),
                                    std::vector<std::uint8_t>(paint_.sources.size(), 0)});
    for (const std::uint32_t face : chart.faces)
      for (const FaceView& v : paint_.seen.of(face)) work->shown[v.view] |= v.quality > 0;
    return work;
  }

  void take_own(std::vector<std::unique_ptr<Work>>& works, Progress& progress) {
    std::vector<std::vector<Work*>> of_view(paint_.sources.size());
    for (const auto& work : works)
      if (const std::uint32_t plane = work->canvas.chart().plane; plane < of_view.size())
        of_view[plane].push_back(work.get());
    for_views(of_view.size(), [&](std::size_t v) {
      progress.check_cancelled();
      if (of_view[v].empty()) return;
      const auto source = paint_.sources.get(v);
      for (Work* work : of_view[v]) work->canvas.take_own(*source);
    });
  }

  /// In the order of the views, whichever thread does it.
  void add_views(std::vector<std::unique_ptr<Work>>& works, std::size_t first, std::size_t end,
                 Progress& progress) {
    std::array<std::shared_ptr<const ViewSource>, kSourcesAtOnce> sources;
    std::array<std::vector<float>, kSourcesAtOnce> weights;
    for_views(end - first, [&](std::size_t i) {
      progress.check_cancelled();
      const std::size_t v = first + i;
      if (std::ranges::none_of(works, [&](const auto& work) { return work->shown[v] != 0; }))
        return;
      sources[i] = paint_.sources.get(v);
      weights[i] = weights_at_vertices(paint_.mesh, paint_.seen, std::uint32_t(v));
    });
    tbb::parallel_for(std::size_t(0), works.size(), [&](std::size_t w) {
      for (std::size_t i = 0; i < end - first; ++i)
        if (works[w]->shown[first + i])
          works[w]->canvas.add({std::uint32_t(first + i), *sources[i], weights[i]}, paint_.noise);
    });
  }

  void finish(const Work& work) {
    std::int64_t texels = 0, filled = 0;
    work.canvas.finish(
        paint_.fill, paint_.detail, [&](const glm::ivec2& texel, const CanvasColour& colour) {
          auto& root = roots_[plan_.index(work.canvas.chart().place + texel)];
          for (int c = 0; c < 3; ++c)
            root[std::size_t(c)] =
                std::uint16_t(kCodes * std::clamp(colour.root[c], 0.0f, 1.0f) + 0.5f);
          ++texels;
          filled += colour.filled;
        });
    texels_ += texels;
    filled_ += filled;
  }

  const Paint& paint_;
  const PagePlan& plan_;
  std::vector<std::array<std::uint16_t, 3>> roots_;
  std::atomic<std::int64_t> texels_{0}, filled_{0};
  std::int64_t most_at_once_ = 0;
};

}  // namespace

PaintedPage paint_page(const Paint& paint, const PagePlan& plan, Progress& progress) {
  Painter painter(paint, plan);
  for (std::size_t chart = 0; chart < plan.charts().size();)
    chart = painter.paint_some(chart, progress);
  return painter.finish();
}

}  // namespace photohull::texture

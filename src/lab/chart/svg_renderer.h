// Charts as SVG documents, drawn by ECharts in an embedded JavaScript engine.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

namespace photohull::chart {

/// Holds a Duktape heap with ECharts loaded; making one takes about a fifth of a second.
class SvgRenderer {
 public:
  SvgRenderer();
  ~SvgRenderer();
  SvgRenderer(const SvgRenderer&) = delete;
  SvgRenderer& operator=(const SvgRenderer&) = delete;

  /// The SVG document of an ECharts option of `width` x `height` pixels. Equal options give equal
  /// bytes. Throws Error with the engine's message when ECharts refuses the option.
  std::string render(const nlohmann::ordered_json& option, int width, int height);

 private:
  struct Heap;
  std::unique_ptr<Heap> heap_;
};

}  // namespace photohull::chart

#include "lab/chart/embedded_files.h"

#define PHOTOHULL_EMBED(symbol, path)                                                  \
  __asm__(".section .rodata\n" #symbol "_begin:\n.incbin \"" path "\"\n" #symbol       \
          "_end:\n"                                                                    \
          ".byte 0\n.global " #symbol "_begin\n.global " #symbol "_end\n.previous\n"); \
  extern "C" const char symbol##_begin[], symbol##_end[]

PHOTOHULL_EMBED(photohull_echarts_js, PHOTOHULL_ECHARTS);
PHOTOHULL_EMBED(photohull_render_svg_js, PHOTOHULL_CHART "/render_svg.js");
PHOTOHULL_EMBED(photohull_page_template, PHOTOHULL_CHART "/page_template.html");

namespace photohull::chart {

std::string_view echarts_js() { return {photohull_echarts_js_begin, photohull_echarts_js_end}; }
std::string_view render_svg_js() {
  return {photohull_render_svg_js_begin, photohull_render_svg_js_end};
}
std::string_view page_template() {
  return {photohull_page_template_begin, photohull_page_template_end};
}

}  // namespace photohull::chart

#include "lab/chart/svg_renderer.h"

#include <cairo.h>
#include <duktape.h>

#include <cstdlib>
#include <regex>

#include "core/error.h"
#include "lab/chart/embedded_files.h"

namespace photohull::chart {
namespace {

/// Widths of texts in the font that the PNG files are drawn with.
class TextMeasure {
 public:
  TextMeasure()
      : surface_(cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1)),
        cairo_(cairo_create(surface_)) {}
  ~TextMeasure() {
    cairo_destroy(cairo_);
    cairo_surface_destroy(surface_);
  }
  TextMeasure(const TextMeasure&) = delete;
  TextMeasure& operator=(const TextMeasure&) = delete;

  /// `font` as in CSS: "bold 18px sans-serif".
  double width(const std::string& text, const std::string& font) {
    const std::size_t px = font.find("px");
    const std::size_t digits = px == std::string::npos ? px : font.find_last_of(' ', px);
    const double size =
        px == std::string::npos
            ? 12
            : std::atof(font.c_str() + (digits == std::string::npos ? 0 : digits + 1));
    const bool bold = font.find("bold") != std::string::npos;
    cairo_select_font_face(cairo_, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo_, size);
    cairo_text_extents_t extents;
    cairo_text_extents(cairo_, text.c_str(), &extents);
    return extents.x_advance;
  }

 private:
  cairo_surface_t* surface_;
  cairo_t* cairo_;
};

duk_ret_t measure(duk_context* context) {
  duk_push_global_stash(context);
  duk_get_prop_string(context, -1, "measure");
  auto* text_measure = static_cast<TextMeasure*>(duk_get_pointer(context, -1));
  duk_push_number(
      context, text_measure->width(duk_safe_to_string(context, 0), duk_safe_to_string(context, 1)));
  return 1;
}

void on_fatal(void*, const char* message) {
  check_failed("duktape", 0, message ? message : "fatal error");
}

/// Fit for a file: what only a pointing hand would see goes, with the running numbers in its names.
std::string static_svg(std::string svg) {
  static const std::regex classes(R"( class="zr[0-9]+-cls-[0-9]+")");
  static const std::regex ids(R"((id="|url\(#)zr[0-9]+-)");
  // librsvg before 2.56 ignores dominant-baseline; a shift by part of the font's size does the same
  // everywhere.
  static const std::regex baselines(R"( dominant-baseline="central")");
  svg = std::regex_replace(svg, classes, "");
  svg = std::regex_replace(svg, ids, "$1");
  svg = std::regex_replace(svg, baselines, R"( dy="0.35em")");
  const std::string open = "<style", close = "</style>";
  for (std::size_t at = svg.find(open); at != std::string::npos; at = svg.find(open, at)) {
    const std::size_t end = svg.find(close, at);
    if (end == std::string::npos) break;
    svg.erase(at, end + close.size() - at);
  }
  return svg;
}

}  // namespace

struct SvgRenderer::Heap {
  TextMeasure text_measure;
  duk_context* context = duk_create_heap(nullptr, nullptr, nullptr, nullptr, on_fatal);

  ~Heap() {
    if (context) duk_destroy_heap(context);
  }
  [[noreturn]] void fail(const char* where) {
    duk_get_prop_string(context, -1, "stack");
    throw Error(concat("charts cannot be drawn: ", where, ": ", duk_safe_to_string(context, -1)));
  }
  void run(std::string_view source, const char* name) {
    duk_push_string(context, name);
    if (duk_pcompile_lstring_filename(context, 0, source.data(), source.size()) != 0 ||
        duk_pcall(context, 0) != 0)
      fail(name);
    duk_pop(context);
  }
};

SvgRenderer::SvgRenderer() : heap_(std::make_unique<Heap>()) {
  if (!heap_->context) throw Error("charts cannot be drawn: out of memory");
  duk_push_global_stash(heap_->context);
  duk_push_pointer(heap_->context, &heap_->text_measure);
  duk_put_prop_string(heap_->context, -2, "measure");
  duk_pop(heap_->context);
  duk_push_c_function(heap_->context, measure, 2);
  duk_put_global_string(heap_->context, "measure");
  heap_->run(render_svg_js(), "render_svg.js");
  heap_->run(echarts_js(), "echarts.min.js");
}

SvgRenderer::~SvgRenderer() = default;

std::string SvgRenderer::render(const nlohmann::ordered_json& option, int width, int height) {
  duk_context* context = heap_->context;
  const std::string text = option.dump();
  duk_get_global_string(context, "renderSvg");
  duk_push_lstring(context, text.data(), text.size());
  duk_push_int(context, width);
  duk_push_int(context, height);
  if (duk_pcall(context, 3) != 0) heap_->fail("ECharts");
  std::string svg = duk_safe_to_string(context, -1);
  duk_pop(context);
  return static_svg(std::move(svg));
}

}  // namespace photohull::chart

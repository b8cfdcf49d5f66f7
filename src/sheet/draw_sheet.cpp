#include "sheet/draw_sheet.h"

#include <cairo-pdf.h>
#include <librsvg/rsvg.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>

#include "core/error.h"
#include "sheet/sheet_parts.h"

namespace photohull {
namespace {

constexpr double kPointsPerMm = 72 / 25.4;

struct Release {
  void operator()(RsvgHandle* p) const { g_object_unref(p); }
  void operator()(cairo_surface_t* p) const { cairo_surface_destroy(p); }
  void operator()(cairo_t* p) const { cairo_destroy(p); }
};
using Handle = std::unique_ptr<RsvgHandle, Release>;
using CairoSurface = std::unique_ptr<cairo_surface_t, Release>;
using Cairo = std::unique_ptr<cairo_t, Release>;

/// Micrometres are fine enough.
std::string number(double value) {
  char text[64];
  const double rounded = std::round(value * 1000) / 1000 + 0.0;
  return {text, std::to_chars(text, text + sizeof text, rounded).ptr};
}

/// Writes in millimetres of the page, y downwards from its top.
class Writer {
 public:
  explicit Writer(const Sheet& sheet) : sheet_(sheet) {}

  std::string run() {
    const std::string w = number(sheet_.page.x), h = number(sheet_.page.y);
    out_ = concat("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"", w, "mm\" height=\"", h,
                  "mm\" viewBox=\"0 0 ", w, " ", h, "\">\n<rect width=\"", w, "\" height=\"", h,
                  "\" fill=\"#fff\"/>\n");
    if (sheet_.is_flat()) {
      draw_free_space();
      std::string path;
      for (const auto& square : sheet_.squares) path += rectangle(square[0], square[1]);
      add_path(path, "#000");
      for (const SheetTag& tag : sheet_.tags) draw_tag(tag);
    }
    for (std::size_t i = 0; i < sheet_.pieces.size(); ++i) draw_piece(i);
    draw_bar();
    return out_ + "</svg>\n";
  }

 private:
  glm::dvec2 on_page(const glm::dvec2& p) const {
    const glm::dvec2 q = p - sheet_.lower_left;
    return {q.x, sheet_.page.y - q.y};
  }
  std::string polygon(std::initializer_list<glm::dvec2> corners) const {
    std::string path;
    for (const glm::dvec2& corner : corners) {
      const glm::dvec2 p = on_page(corner);
      path += concat(path.empty() ? "M" : "L", number(p.x), " ", number(p.y));
    }
    return path + "z";
  }
  std::string rectangle(const glm::dvec2& low, const glm::dvec2& high) const {
    return polygon({low, {high.x, low.y}, high, {low.x, high.y}});
  }
  void add_path(const std::string& path, const std::string& colour) {
    if (!path.empty()) out_ += concat("<path d=\"", path, "\" fill=\"", colour, "\"/>\n");
  }

  void draw_tag(const SheetTag& tag) {
    const auto& c = tag.corners;
    add_path(polygon({c[0], c[1], c[2], c[3]}), "#000");
    const auto cells = tag_cells(sheet_.dictionary, tag.id);
    const double n = double(cells.size());
    const auto at = [&](double x, double y) {
      return glm::mix(glm::mix(c[0], c[1], x / n), glm::mix(c[3], c[2], x / n), y / n);
    };
    std::string path;  // one for all cells, so that none shows its edge between two white ones
    for (std::size_t y = 0; y < cells.size(); ++y)
      for (std::size_t x = 0, last = 0; x < cells.size(); x = last + 1) {
        for (last = x; last < cells.size() && cells[y][last];) ++last;
        const double top = double(y), left = double(x), right = double(last);
        if (last > x)
          path += polygon({at(left, top), at(right, top), at(right, top + 1), at(left, top + 1)});
      }
    add_path(path, "#fff");
  }

  /// Its outline to cut along, the tab under the next piece, and lines at every ten millimetres.
  void draw_piece(std::size_t i) {
    constexpr double kStep = 10, kLine = 0.8;  // mm
    const StripPiece& piece = sheet_.pieces[i];
    const double wide = piece.to - piece.from;
    const glm::dvec2 low = piece.low, end = low + glm::dvec2(wide, 0), up(0, sheet_.strip);
    out_ += concat("<path d=\"", rectangle(low, end + up + glm::dvec2(kGlued, 0)),
                   "\" fill=\"none\" stroke=\"#888\" stroke-width=\"0.15\"/>\n");
    out_ += concat("<path d=\"", polygon({end, end + up}),
                   "\" fill=\"none\" stroke=\"#888\" stroke-width=\"0.15\" "
                   "stroke-dasharray=\"1 1\"/>\n");
    std::string marks;
    for (double x = kStep * std::ceil(piece.from / kStep - 1e-9); x <= piece.to + 1e-9; x += kStep)
      marks += rectangle(low + glm::dvec2(x - piece.from - 0.05, 0),
                         low + glm::dvec2(x - piece.from + 0.05, kLine));
    add_path(marks, "#888");
    const bool last = i + 1 == sheet_.pieces.size();
    add_text(end + glm::dvec2(1, 0.5 * sheet_.strip - 1), 2.2,
             concat(i + 1, "|", last ? 1 : i + 2));
    for (const SheetTag& tag : sheet_.tags) {
      if (tag.corners[0].x < piece.from || tag.corners[1].x > piece.to) continue;
      SheetTag placed = tag;
      for (glm::dvec2& corner : placed.corners) corner += low - glm::dvec2(piece.from, 0);
      draw_tag(placed);
    }
  }

  void draw_free_space() {
    const glm::dvec2 low = sheet_.free_min, high = sheet_.free_max;
    out_ += concat("<path d=\"", rectangle(low, high),
                   "\" fill=\"none\" stroke=\"#ccc\" stroke-width=\"0.2\"/>\n");
  }

  void draw_bar() {
    constexpr double kHalf = 1.5, kTick = 0.3;  // mm
    const glm::dvec2 a = sheet_.bar_from, b = sheet_.bar_to, up(0, kHalf), thin(0, kTick / 2);
    if (!(sheet_.bar_length() > 0)) return;
    const glm::dvec2 wide(kTick, 0);
    // The outer edges of its ends are as far apart as it says.
    add_path(rectangle(a - up, a + up + wide) + rectangle(b - up - wide, b + up) +
                 rectangle(a - thin, b + thin),
             "#000");
    const std::string length = number(sheet_.bar_length());
    add_text(a + glm::dvec2(0, kHalf + 1.2), 3.6,
             concat(length, " mm between the outer edges of the bar's ends, printed at 100 %"));
    const std::string around = sheet_.is_flat() ? "" : concat(" ", number(sheet_.diameter), " mm");
    add_text(b + glm::dvec2(3, -1), 3, concat("photohull, ", sheet_.kind, around));
    if (!sheet_.is_flat())
      add_text(a + glm::dvec2(0, -4.8), 3,
               "cut along the lines, glue each dashed tab under the piece whose number is on it; "
               "tags outwards, this side up");
  }
  void add_text(const glm::dvec2& place, double size, const std::string& text) {
    const glm::dvec2 p = on_page(place);
    out_ += concat("<text x=\"", number(p.x), "\" y=\"", number(p.y), "\" font-size=\"",
                   number(size), "\" font-family=\"sans-serif\">", text, "</text>\n");
  }

  const Sheet& sheet_;
  std::string out_;
};

[[noreturn]] void fail(const std::string& reason) {
  throw Error("the sheet cannot be drawn: " + reason);
}

void draw(const std::string& svg, double width, double height, cairo_surface_t* surface) {
  GError* error = nullptr;
  const auto check = [&](bool good) {
    if (good) return;
    const std::string reason = error ? error->message : "unknown reason";
    if (error) g_error_free(error);
    fail(reason);
  };
  const Handle handle(
      rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), &error));
  check(handle != nullptr);
  const Cairo cairo(cairo_create(surface));
  const RsvgRectangle viewport{0, 0, width, height};
  check(rsvg_handle_render_document(handle.get(), cairo.get(), &viewport, &error));
}

cairo_status_t append(void* text, const unsigned char* data, unsigned int size) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(data), size);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

std::string sheet_svg(const Sheet& sheet) { return Writer(sheet).run(); }

std::string sheet_pdf(const Sheet& sheet) {
  std::string pdf;
  const double width = sheet.page.x * kPointsPerMm, height = sheet.page.y * kPointsPerMm;
  const CairoSurface surface(cairo_pdf_surface_create_for_stream(append, &pdf, width, height));
  // Else it is the time now: other bytes every time.
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE,
                                 "1970-01-01T00:00:00Z");
  draw(sheet_svg(sheet), width, height, surface.get());
  cairo_surface_finish(surface.get());
  const cairo_status_t status = cairo_surface_status(surface.get());
  if (status != CAIRO_STATUS_SUCCESS) fail(cairo_status_to_string(status));
  return pdf;
}

SheetPicture sheet_picture(const Sheet& sheet, double texels_per_mm) {
  SheetPicture p;
  p.texels_per_mm = texels_per_mm, p.lower_left = sheet.lower_left;
  p.width = int(std::ceil(sheet.page.x * texels_per_mm - 1e-9));
  p.height = int(std::ceil(sheet.page.y * texels_per_mm - 1e-9));
  PHOTOHULL_CHECK(p.width > 0 && p.height > 0);
  const CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, p.width, p.height));
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS)
    fail(cairo_status_to_string(cairo_surface_status(surface.get())));
  // Texels are square: a page that ends within one is drawn from its lower edge upwards.
  cairo_surface_set_device_offset(surface.get(), 0, p.height - sheet.page.y * texels_per_mm);
  draw(sheet_svg(sheet), sheet.page.x * texels_per_mm, sheet.page.y * texels_per_mm, surface.get());
  cairo_surface_flush(surface.get());
  const unsigned char* pixels = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  p.light.resize(std::size_t(p.width) * std::size_t(p.height));
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x)
      p.light[std::size_t(y) * std::size_t(p.width) + std::size_t(x)] =
          pixels[std::size_t(y) * std::size_t(stride) + std::size_t(x) * 4 + 1];
  return p;
}

float SheetPicture::at(const glm::dvec2& place) const {
  const glm::dvec2 q = (place - lower_left) * texels_per_mm;
  const double x = q.x - 0.5, y = height - q.y - 0.5;
  if (!(x >= -0.5 && y >= -0.5 && x <= width - 0.5 && y <= height - 0.5)) return -1;
  const int x0 = std::clamp(int(std::floor(x)), 0, std::max(0, width - 2));
  const int y0 = std::clamp(int(std::floor(y)), 0, std::max(0, height - 2));
  const float u = float(std::clamp(x - x0, 0.0, 1.0)), v = float(std::clamp(y - y0, 0.0, 1.0));
  const std::uint8_t* row = &light[std::size_t(y0) * std::size_t(width) + std::size_t(x0)];
  const std::uint8_t* below = row + (height > 1 ? width : 0);
  const int right = width > 1 ? 1 : 0;
  return ((1 - v) * ((1 - u) * row[0] + u * row[right]) +
          v * ((1 - u) * below[0] + u * below[right])) /
         255;
}

}  // namespace photohull

#include "lab/chart/png.h"

#include <librsvg/rsvg.h>

#include <memory>

#include "core/atomic_file.h"
#include "core/error.h"

namespace photohull::chart {
namespace {

struct Release {
  void operator()(RsvgHandle* p) const { g_object_unref(p); }
  void operator()(cairo_surface_t* p) const { cairo_surface_destroy(p); }
  void operator()(cairo_t* p) const { cairo_destroy(p); }
};

[[noreturn]] void fail(GError* error) {
  const std::string reason = error ? error->message : "unknown reason";
  if (error) g_error_free(error);
  throw Error("the chart cannot be drawn: " + reason);
}

cairo_status_t append(void* text, const unsigned char* data, unsigned int size) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(data), size);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

std::string to_png(const std::string& svg, int width, int height) {
  PHOTOHULL_CHECK(width > 0 && height > 0);
  GError* error = nullptr;
  const std::unique_ptr<RsvgHandle, Release> handle(
      rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), &error));
  if (!handle) fail(error);
  const std::unique_ptr<cairo_surface_t, Release> surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height));
  const std::unique_ptr<cairo_t, Release> cairo(cairo_create(surface.get()));
  cairo_set_source_rgb(cairo.get(), 1, 1, 1);
  cairo_paint(cairo.get());
  const RsvgRectangle viewport{0, 0, double(width), double(height)};
  if (!rsvg_handle_render_document(handle.get(), cairo.get(), &viewport, &error)) fail(error);
  std::string png;
  const cairo_status_t status = cairo_surface_write_to_png_stream(surface.get(), append, &png);
  if (status != CAIRO_STATUS_SUCCESS)
    throw Error(concat("the chart cannot be drawn: ", cairo_status_to_string(status)));
  return png;
}

void write_png(const std::string& svg, int width, int height, const std::filesystem::path& path) {
  std::string png;
  try {
    png = to_png(svg, width, height);
  } catch (const Error& e) {
    throw Error(concat(path.string(), ": ", e.what()));
  }
  write_atomically(path, png);
}

}  // namespace photohull::chart

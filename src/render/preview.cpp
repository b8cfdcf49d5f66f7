#include "render/preview.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "render/choose_views.h"
#include "render/photograph.h"
#include "render/rasterizer.h"

namespace photohull {
namespace {

using render::Window;

constexpr int kGap = 8;              // pixels between panels
constexpr double kMargin = 0.06;     // of the mesh's projection around it
constexpr double kMaxEnlarge = 2.0;  // a photograph's pixels are not blown up further

RgbImage blank(int width, int height) {
  return {width, height,
          std::vector<std::uint8_t>(std::size_t(width) * height * 3, render::kBackground)};
}

void paste(const RgbImage& panel, int x, int y, RgbImage& page) {
  for (int row = 0; row < panel.height; ++row)
    std::copy_n(&panel.rgb[std::size_t(row) * panel.width * 3], std::size_t(panel.width) * 3,
                &page.rgb[(std::size_t(y + row) * page.width + x) * 3]);
}

Window whole_image(const Camera& camera) {
  return {-0.5, -0.5, double(camera.intrinsics.width), double(camera.intrinsics.height), 0, 0};
}

/// The part of a window that lies on the photograph, in whole pixels; all of the photograph when
/// there is none.
Window clip(const Window& window, const Camera& camera) {
  const Window image = whole_image(camera);
  const auto snap = [](double edge) { return std::floor(edge + 0.5) - 0.5; };
  Window out = window;
  out.x = std::max(image.x, snap(window.x));
  out.y = std::max(image.y, snap(window.y));
  out.width = std::min(image.x + image.width, snap(window.x + window.width)) - out.x;
  out.height = std::min(image.y + image.height, snap(window.y + window.height)) - out.y;
  if (out.width >= 1 && out.height >= 1) return out;
  out.x = image.x;
  out.y = image.y;
  out.width = image.width;
  out.height = image.height;
  return out;
}

/// Widens a window about its centre to the aspect of a panel.
Window fit_aspect(Window window, double width, double height) {
  const double wanted = std::max(window.width, window.height * width / height);
  window.x -= 0.5 * (wanted - window.width);
  window.width = wanted;
  const double tall = wanted * height / width;
  window.y -= 0.5 * (tall - window.height);
  window.height = tall;
  return window;
}

struct Panel {
  double scale;  ///< panel pixels a photograph's pixel
  int width, height;
};

Panel panel_for(Window& window, int edge) {
  const double scale = std::min(edge / std::max(window.width, window.height), kMaxEnlarge);
  Panel out{scale, std::max(1, int(window.width * scale)), std::max(1, int(window.height * scale))};
  // Exactly the panel's pixels, so that photograph and rendering agree to a fraction of a pixel.
  window.width = out.width / scale;
  window.height = out.height / scale;
  return out;
}

RgbImage photograph(const PreparedView& view, const Window& window, const Panel& panel) {
  return render::cut_photograph(view.image, window.x, window.y, panel.scale, panel.width,
                                panel.height);
}

/// `drawn` is the mesh, or its textured form.
template <typename Drawn>
RgbImage preview_of(gpu::Context& context, const Drawn& drawn, const TriMesh& mesh,
                    std::span<const PreparedView> views, const PreviewOptions& options) {
  PHOTOHULL_CHECK(!views.empty());
  PHOTOHULL_CHECK(options.panel_edge >= 16 && options.panel_edge <= 4096);
  PHOTOHULL_CHECK(options.other_views >= 0 && options.other_views <= 4);
  if (mesh.triangles.empty()) {
    Window window = whole_image(views[0].camera);
    return photograph(views[0], window, panel_for(window, options.panel_edge));
  }
  PHOTOHULL_CHECK_OP(mesh.normals.size(), ==, mesh.positions.size());
  const int main = render::choose_main_view(mesh, views);
  const std::vector<int> others =
      render::choose_other_views(mesh, views, main, options.other_views);

  const Camera& camera = views[main].camera;
  Window window = clip(render::frame_mesh(mesh, camera, kMargin), camera);
  const Panel panel = panel_for(window, options.panel_edge);
  const int columns = 2 * int(others.size());
  const int page_width = 3 * panel.width + 2 * kGap;
  const int small_width = columns ? std::max(1, (page_width - (columns - 1) * kGap) / columns) : 0;
  const int small_height = columns ? std::max(1, small_width * panel.height / panel.width) : 0;
  RgbImage page = blank(page_width, panel.height + (columns ? kGap + small_height : 0));

  render::Rasterizer rasterizer(context, drawn);
  const render::Rendering large = rasterizer.draw(camera, window, panel.width, panel.height);
  paste(photograph(views[main], window, panel), 0, 0, page);
  paste(large.coloured, panel.width + kGap, 0, page);
  paste(large.clay, 2 * (panel.width + kGap), 0, page);
  for (int i = 0; i < int(others.size()); ++i) {
    const Camera& other = views[others[i]].camera;
    const Window frame =
        fit_aspect(render::frame_mesh(mesh, other, kMargin), small_width, small_height);
    const render::Rendering small = rasterizer.draw(other, frame, small_width, small_height);
    const int y = panel.height + kGap, step = small_width + kGap;
    paste(small.clay, 2 * i * step, y, page);
    paste(small.coloured, (2 * i + 1) * step, y, page);
  }
  return page;
}

}  // namespace

RgbImage render_preview(gpu::Context& context, const TriMesh& mesh,
                        std::span<const PreparedView> views, const PreviewOptions& options) {
  return preview_of(context, mesh, mesh, views, options);
}

RgbImage render_preview(gpu::Context& context, const TexturedMesh& textured,
                        std::span<const PreparedView> views, const PreviewOptions& options) {
  return preview_of(context, textured, textured.mesh, views, options);
}

}  // namespace photohull

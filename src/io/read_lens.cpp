#include "io/read_lens.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/option_word.h"
#include "core/scaled_size.h"
#include "io/find_scene.h"
#include "io/formats.h"
#include "io/scene_readers.h"
#include "io/text_file.h"
#include "io/usable_views.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

bool alike(const CameraLens& a, const CameraLens& b) {
  constexpr double kTolerance = 1e-9;
  const auto near = [](double x, double y) {
    return std::abs(x - y) <= kTolerance * std::max({1.0, std::abs(x), std::abs(y)});
  };
  const Intrinsics &k = a.intrinsics, &l = b.intrinsics;
  bool same = k.width == l.width && k.height == l.height && near(k.fx, l.fx) && near(k.fy, l.fy) &&
              near(k.skew, l.skew) && near(k.cx, l.cx) && near(k.cy, l.cy) &&
              a.distortion.model == b.distortion.model;
  for (std::size_t i = 0; i < a.distortion.coefficients.size(); ++i)
    same = same && near(a.distortion.coefficients[i], b.distortion.coefficients[i]);
  return same;
}

/// Of a scene all of whose views have the same; formats without a size mean `width` x `height`.
CameraLens lens_of_scene(const fs::path& path, int width, int height) {
  const SceneLocation location = find_scene(path, std::nullopt);
  if (location.format == SceneFormat::kRealityCapture)
    throw Error(concat(path.string(),
                       ": RealityCapture states lenses as shares of photographs; convert the scene "
                       "to another format first"));
  const RawScene raw = read_raw_scene(location.format, location.file, {});
  if (raw.views.empty()) throw Error(concat(path.string(), ": lists no camera"));
  CameraLens first;
  for (std::size_t i = 0; i < raw.views.size(); ++i) {
    RawView view = raw.views[i];
    Intrinsics& k = view.camera.intrinsics;
    if (k.width == 0) k.width = width;
    if (k.height == 0) k.height = height;
    const CameraLens lens{complete_camera(view, raw.pixel_center).intrinsics, view.distortion};
    if (i == 0)
      first = lens;
    else if (!alike(first, lens))
      throw Error(concat(path.string(), ": lists several lenses (that of ", view.listed,
                         " is another than that of ", raw.views[0].listed, "); ",
                         option_word("lens_from"), " takes a file of one lens"));
  }
  return first;
}

}  // namespace

CameraLens read_lens(const fs::path& file, int width, int height, const std::string& camera) {
  CameraLens lens = is_file(file) && is_calibration(file) ? calibrated_lens(file, camera)
                                                          : lens_of_scene(file, width, height);
  const Intrinsics& k = lens.intrinsics;
  if (k.width == width && k.height == height) return lens;
  if (!is_scaled_copy(width, height, k.width, k.height))
    throw Error(concat(file.string(), ": the lens is for pictures of ", k.width, " x ", k.height,
                       ", but those of the board are ", width, " x ", height,
                       "; use the same camera's, whole and not turned"));
  lens.intrinsics = scaled_to(k, width, height);
  return lens;
}

}  // namespace photohull::io

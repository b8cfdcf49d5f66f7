// carve_with SCENE RESOLUTION MESH.ply [field=value ...]: space carving with any field of
// PhotoOptions changed, for bench/photo_defaults.py, which picks the defaults.
#include <cstdio>
#include <ctime>
#include <functional>
#include <map>
#include <string>

#include "calib/crop.h"
#include "calib/noise.h"
#include "calib/prepare_views.h"
#include "calib/silhouette.h"
#include "carving/fit_grid.h"
#include "carving/hull.h"
#include "carving/photo.h"
#include "core/error.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "volume/components.h"
#include "volume/extract_mesh.h"
#include "volume/write_mesh.h"

namespace {

using namespace photohull;

void set_field(carving::PhotoOptions& o, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  const std::string name = assignment.substr(0, equals);
  const double value = std::stod(assignment.substr(equals + 1));
  const std::map<std::string, std::function<void()>> fields{
      {"keep_score", [&] { o.keep_score = value; }},
      {"better_by", [&] { o.better_by = value; }},
      {"min_views", [&] { o.min_views = int(value); }},
      {"min_texture", [&] { o.min_texture = value; }},
      {"supersample", [&] { o.supersample = int(value); }},
      {"front_face", [&] { o.front_face = value != 0; }},
      {"depth_bias", [&] { o.depth_bias = value; }},
      {"max_path", [&] { o.max_path = int(value); }},
      {"max_rounds", [&] { o.max_rounds = int(value); }}};
  const auto field = fields.find(name);
  if (field == fields.end()) throw UsageError("no field '" + name + "' in PhotoOptions");
  field->second();
}

int run(int argc, char** argv) {
  if (argc < 4) throw UsageError("usage: carve_with SCENE RESOLUTION MESH.ply [field=value ...]");
  Progress progress;
  const Scene scene = io::load_scene(argv[1]);
  const ViewLoader loader{[](const auto& path) { return io::read_image(path); },
                          [](const auto& path) { return io::read_mask(path); }};
  std::vector<View> views = prepare_views(scene, loader, {}, progress).views;
  carving::PhotoOptions options;
  options.noise_sigma = std::max(estimate_image_noise(views[0].image), 1e-3);
  for (int i = 4; i < argc; ++i) set_field(options, argv[i]);
  for (View& view : views) crop_to_box(*scene.box, 24, view);
  const std::vector<Camera> cameras = projtex::cameras_of(views);
  std::vector<SilhouetteDistance> distances;
  for (const View& view : views) distances.push_back(silhouette_distance(view.mask));
  std::vector<carving::Silhouette> silhouettes;
  for (std::size_t i = 0; i < views.size(); ++i)
    silhouettes.push_back({&views[i].mask, &distances[i]});
  const auto context = gpu::Context::create("auto");
  const GridSpec grid =
      carving::fit_grid(*scene.box, carving::voxel_size_for(*scene.box, std::stoi(argv[2])));
  const SparseVolume hull =
      carving::carve_silhouette(*context, grid, *scene.box, cameras, silhouettes, {}, progress);
  const projtex::ImageSet images(views);
  const std::clock_t start = std::clock();
  SparseVolume volume = carving::carve_photo(*context, hull, images, cameras, options, progress);
  std::printf("%.2f\n", double(std::clock() - start) / CLOCKS_PER_SEC);
  remove_small_components(volume, 5e-4);
  write_ply(argv[3], extract_mesh(volume));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "carve_with: %s\n", e.what());
    return 1;
  }
}

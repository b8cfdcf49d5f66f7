#include "lab/visibility/study.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/error.h"
#include "core/option_word.h"
#include "lab/visibility/study_parts.h"
#include "lab/visibility/study_receivers.h"
#include "visibility/truth.h"
#include "visibility/viewpoints.h"

namespace photohull::visibility {
namespace {

using glm::dvec3;

constexpr double kBiases[] = {0, 0.125, 0.25, 0.5, 1, 2, 4, 8, 16, 32};
constexpr double kAngles[] = {2, 10, 20, 35, 50, 70, 90};
constexpr int kAngleResolution = 1024, kBiasResolution = 1024;
constexpr const char* kAngleTechniques[] = {
    "virtual-normal", "fit", "lispsm", "general-lispsm", "zp2", "zp3", "zp4"};

double milliseconds(const gpu::Context& context, const gpu::LaunchStatistics& s) {
  return 1e3 * (context.device().software ? s.cpu_seconds : s.seconds);
}

/// Spent in the module's launches; `tests`: in those that ask maps, else in those that draw them.
double spent(gpu::Context& context, bool tests) {
  double sum = 0;
  for (const auto& [name, statistics] : context.statistics())
    if (name.starts_with("visibility_") && name.starts_with("visibility_test") == tests)
      sum += milliseconds(context, statistics);
  return sum;
}

Box bounds_of(const TriMesh& mesh) {
  Box box{dvec3(1e300), dvec3(-1e300)};
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    box.min = glm::min(box.min, mesh.world(i));
    box.max = glm::max(box.max, mesh.world(i));
  }
  return box;
}

std::vector<Technique> chosen_techniques(const StudyOptions& options) {
  if (options.techniques.empty()) return named_techniques();
  std::vector<Technique> out;
  for (const std::string& name : options.techniques)
    out.push_back(parse_technique(option_word("techniques"), name));
  return out;
}

/// What is measured of one scene.
class SceneStudy {
 public:
  SceneStudy(gpu::Context& context, const StudyOptions& options, const StudyScene& scene)
      : context_(context),
        options_(options),
        scene_(scene),
        rays_(scene.mesh),
        geometry_(Geometry::of_mesh(scene.mesh)),
        receivers_(receivers_of(rays_, scene.mesh, scene.viewpoint, scene.eye, options.width,
                                options.height)),
        silhouettes_(rays_, scene.viewpoint, bounds_of(scene.mesh), scene.eye, options.silhouettes,
                     options.seed) {}

  SceneInfo info() const {
    SceneInfo i;
    i.name = scene_.name;
    i.triangles = std::int64_t(scene_.mesh.triangles.size());
    i.vertices = std::int64_t(scene_.mesh.positions.size());
    i.receivers = std::int64_t(receivers_.samples.size());
    const auto seen = std::count(receivers_.truth.begin(), receivers_.truth.end(), 1);
    i.visible_percent = 100.0 * double(seen) / double(std::max<std::int64_t>(i.receivers, 1));
    return i;
  }

  StudyCell measure(Technique technique, int resolution) {
    technique.resolution = resolution;
    StudyCell cell{scene_.name, technique.name, resolution, {}, 0, 1e30, 1e30, 0};
    for (int repeat = 0; repeat <= options_.repeats; ++repeat) {
      const double map_before = spent(context_, false), test_before = spent(context_, true);
      const VisibilityMap map =
          render_map(context_, scene_.viewpoint, geometry_, technique, scene_.eye);
      const std::vector<float> found = visible(context_, map, receivers_.samples);
      if (repeat == 0) {  // compiles; its times do not count
        cell.errors = errors_of(found, receivers_.truth);
        cell.silhouette_texels = silhouettes_.error(context_, map, resolution);
        cell.bytes = std::int64_t(map.bytes());
        continue;
      }
      cell.map_ms = std::min(cell.map_ms, spent(context_, false) - map_before);
      cell.test_ms = std::min(cell.test_ms, spent(context_, true) - test_before);
    }
    return cell;
  }

  std::vector<BiasCell> sweep_bias() {
    std::vector<BiasCell> out;
    for (const double bias : kBiases) {
      Technique t;
      t.resolution = kBiasResolution;
      t.bias_texels = bias;
      const VisibilityMap map = render_map(context_, scene_.viewpoint, geometry_, t);
      out.push_back({scene_.name, t.resolution, bias,
                     errors_of(visible(context_, map, receivers_.samples), receivers_.truth)});
    }
    return out;
  }

  std::vector<ViewCell> time_views() {
    std::vector<ViewCell> out;
    for (const bool close : {false, true}) {
      const Camera& eye = close ? scene_.close_eye : scene_.eye;
      Technique t;
      t.resolution = 800;
      double best = 1e30;
      for (int repeat = 0; repeat <= options_.repeats; ++repeat) {
        const double before = spent(context_, false);
        render_map(context_, eye, geometry_, t);
        if (repeat) best = std::min(best, spent(context_, false) - before);
      }
      out.push_back({scene_.name, close, best, std::int64_t(receivers_.samples.size())});
    }
    return out;
  }

  /// The viewpoint on a great circle through the receivers' camera.
  std::vector<AngleCell> turn_viewpoint(Progress& progress) {
    std::vector<AngleCell> out;
    const Box box = bounds_of(scene_.mesh);
    const double radius = 0.5 * box.diagonal();
    const dvec3 axis = glm::normalize(scene_.close_eye.center() - box.center());
    const dvec3 up = glm::normalize(dvec3(0, 0, 1) - axis.z * axis);
    for (const double degrees : kAngles) {
      progress.check_cancelled();
      const double a = degrees * std::numbers::pi / 180;
      const dvec3 towards = std::cos(a) * axis + std::sin(a) * up;
      const Camera viewpoint =
          frame_sphere(box.center() + 3 * radius * towards, box.center(), 0.8 * radius, 1024, 1024);
      const Receivers receivers = receivers_of(rays_, scene_.mesh, viewpoint, scene_.close_eye,
                                               options_.width, options_.height);
      const Silhouettes silhouettes(rays_, viewpoint, box, scene_.close_eye, options_.silhouettes,
                                    options_.seed);
      for (const char* name : kAngleTechniques) {
        Technique t = parse_technique("technique", "virtual-normal");
        const std::string text = name;
        if (text == "fit") t.warp = Warp::kFit;
        if (text == "lispsm") t.warp = Warp::kLispsm;
        if (text == "general-lispsm" || text.starts_with("zp")) t.warp = Warp::kGeneralLispsm;
        if (text.starts_with("zp")) t.partitions = text[2] - '0';
        t.name = text;
        t.resolution = kAngleResolution;
        const VisibilityMap map = render_map(context_, viewpoint, geometry_, t, scene_.close_eye);
        out.push_back({degrees, text,
                       errors_of(visible(context_, map, receivers.samples), receivers.truth),
                       silhouettes.error(context_, map, kAngleResolution), map.layout().warped});
      }
    }
    return out;
  }

  std::vector<DetectionCell> detect(int resolution) {
    return detect_triangles(context_, scene_, geometry_, resolution, options_.seed);
  }

 private:
  gpu::Context& context_;
  const StudyOptions& options_;
  const StudyScene& scene_;
  RayScene rays_;
  Geometry geometry_;
  Receivers receivers_;
  Silhouettes silhouettes_;
};

}  // namespace

void describe(Described& to, StudyOptions& o) {
  to.list("scenes", &o.scenes, {}, "names", "some of the scenes");
  to.list("resolutions", &o.resolutions, from_to(16, 8192), "numbers from 16 to 8192",
          "texels along a map's side");
  to.list("techniques", &o.techniques, {}, "names", "some of the techniques (default: all)");
  to.number("repeats", &o.repeats, from_to(1, 100), "",
            "times that each timing is taken; the quickest counts");
  to.number("width", &o.width, from_to(16, 4096), "pixels", "width of the receivers' picture");
  to.number("height", &o.height, from_to(16, 4096), "pixels", "height of the receivers' picture");
  to.number("silhouettes", &o.silhouettes, from_to(10, 100000), "",
            "places on silhouettes that are compared");
  to.number("volume_bricks", &o.volume_bricks, from_to(4, 128), "bricks",
            "side of the volume that is drawn in two ways");
}

void StudyOptions::validate() const {
  check_options(*this);
  const auto& names = study_scene_names();
  for (const std::string& s : scenes)
    if (std::find(names.begin(), names.end(), s) == names.end())
      throw UsageError(concat(option_word("scenes", s), ": there is no such scene"));
  for (const std::string& t : techniques) parse_technique(option_word("techniques"), t);
  if (scenes.empty() || resolutions.empty()) throw UsageError("nothing to measure");
}

Study study_visibility(gpu::Context& context, const StudyOptions& options, Progress& progress) {
  options.validate();
  Study study;
  const std::vector<Technique> techniques = chosen_techniques(options);
  const double cells =
      double(options.scenes.size() * options.resolutions.size() * techniques.size());
  for (const std::string& name : options.scenes) {
    const StudyScene scene = make_study_scene(name);
    SceneStudy one(context, options, scene);
    study.scenes.push_back(one.info());
    for (const int resolution : options.resolutions)
      for (const Technique& technique : techniques) {
        progress.check_cancelled();
        try {
          study.cells.push_back(one.measure(technique, resolution));
        } catch (const Error& error) {
          study.left_out.push_back({name, technique.name, resolution, error.what()});
        }
        progress.update(double(study.cells.size() + study.left_out.size()) / cells);
      }
    for (const BiasCell& cell : one.sweep_bias()) study.biases.push_back(cell);
    for (const ViewCell& cell : one.time_views()) study.views.push_back(cell);
    for (const int resolution : options.resolutions) {
      try {
        for (const DetectionCell& cell : one.detect(resolution)) study.detection.push_back(cell);
      } catch (const Error& error) {
        study.left_out.push_back({name, "detection", resolution, error.what()});
      }
    }
    // A viewpoint that turns, on the first scene only.
    if (&name == &options.scenes.front()) study.angles = one.turn_viewpoint(progress);
    context.release_deleted();
  }
  study.volumes = study_volumes(context, options, progress);
  return study;
}

StudyPicture picture_errors(gpu::Context& context, const StudyScene& scene,
                            const Technique& technique, int edge) {
  const RayScene rays(scene.mesh);
  Camera camera = scene.close_eye;
  camera.intrinsics.width = camera.intrinsics.height = edge;
  camera.intrinsics.cx = camera.intrinsics.cy = 0.5 * (edge - 1);
  const Receivers receivers = receivers_of(rays, scene.mesh, scene.viewpoint, camera, edge, edge);
  const VisibilityMap map =
      render_map(context, scene.viewpoint, Geometry::of_mesh(scene.mesh), technique, camera);
  const std::vector<float> found = visible(context, map, receivers.samples);
  StudyPicture picture{edge, std::vector<std::uint8_t>(std::size_t(edge) * edge * 3, 96)};
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Sample& s = receivers.samples[i];
    const double light = glm::dot(s.normal, glm::normalize(scene.viewpoint.center() - s.position));
    const auto shade = std::uint8_t(40 + 180 * light * double(found[i]));
    std::uint8_t* rgb = &picture.rgb[std::size_t(receivers.pixel[i]) * 3];
    const double lost = receivers.truth[i] ? 1 - found[i] : 0;
    const double passed = receivers.truth[i] ? 0 : double(found[i]);
    rgb[0] = std::uint8_t(shade + (255 - shade) * lost - shade * passed);
    rgb[1] = std::uint8_t(shade * (1 - lost) * (1 - passed));
    rgb[2] = std::uint8_t(shade * (1 - lost) + (255 - shade) * passed);
  }
  return picture;
}

}  // namespace photohull::visibility

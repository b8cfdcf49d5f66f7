#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/front/command_table.h"
#include "commands.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/process_limits.h"
#include "gpu/context.h"
#include "gpu/device_options.h"
#include "io/film.h"
#include "io/image_file.h"
#include "option_flags.h"
#include "pipeline/read_result.h"
#include "render/rasterizer.h"
#include "render/turntable.h"
#include "scene_arguments.h"
#include "terminal_progress.h"

namespace photohull::cli {
namespace {

constexpr int kSmallestSide = 16, kLargestSide = 4096;   // pixels
constexpr double kReadWeight = 0.1, kStillWeight = 0.1;  // of the progress; a film is 1

struct RenderArguments {
  std::string folder, size = "1280x720", background = "grey";
  std::optional<std::string> turntable, picture, camera;
  render::TurntableOptions turn;
  double rate = 30;
  bool clay = false;
  gpu::DeviceOptions device;
};

struct Size {
  int width = 0, height = 0;
};

Size read_size(const std::string& text) {
  Size size;
  int used = 0;
  const bool read = std::sscanf(text.c_str(), "%5dx%5d%n", &size.width, &size.height, &used) == 2 &&
                    std::size_t(used) == text.size();
  const auto legal = [](int side) { return side >= kSmallestSide && side <= kLargestSide; };
  if (!read || !legal(size.width) || !legal(size.height))
    throw UsageError(concat("--size ", text, ": expected WIDTHxHEIGHT in pixels, each from ",
                            kSmallestSide, " to ", kLargestSide));
  return size;
}

render::Colour read_colour(const std::string& text) {
  if (text == "grey") return {render::kBackground, render::kBackground, render::kBackground};
  if (text == "white") return {255, 255, 255};
  if (text == "black") return {0, 0, 0};
  unsigned red = 0, green = 0, blue = 0;
  int used = 0;
  if (text.size() != 7 || text.find_first_not_of("#0123456789abcdefABCDEF") != text.npos ||
      std::sscanf(text.c_str(), "#%2x%2x%2x%n", &red, &green, &blue, &used) != 3 || used != 7)
    throw UsageError(concat("--background ", text, ": expected grey, white, black or #RRGGBB"));
  return {std::uint8_t(red), std::uint8_t(green), std::uint8_t(blue)};
}

void check(const RenderArguments& a) {
  if (a.folder.empty()) throw UsageError("DIR is empty: give the folder of the results");
  if (!a.turntable && !a.picture)
    throw UsageError("nothing to draw: give --turntable FILE, or --picture FILE, or both");
  if (a.camera && !a.picture)
    throw UsageError("--camera needs --picture FILE: the PNG file that it is drawn to");
  if (a.camera && a.camera->empty())
    throw UsageError("--camera is empty: give the name or the index of a view");
  if (a.picture && a.picture->empty()) throw UsageError("--picture is empty: give a PNG file");
}

/// What draws the model, with all that pictures of it share.
class Painter {
 public:
  Painter(const RenderArguments& a, const Size& size)
      : size_(size),
        look_(a.clay ? render::Look::kClay : render::Look::kColours),
        background_(read_colour(a.background)) {}

  void load(const RenderArguments& a) {
    model_ = pipeline::read_result(a.folder);
    if (a.camera) camera_ = pipeline::find_camera(model_.look, *a.camera).camera;
    context_ = gpu::Context::create(a.device.device, a.device.threads);
    rasterizer_ = model_.textured
                      ? std::make_unique<render::Rasterizer>(*context_, *model_.textured)
                      : std::make_unique<render::Rasterizer>(*context_, model_.mesh);
  }

  std::vector<render::Shot> turn(const render::TurntableOptions& options) const {
    glm::dvec3 from = model_.shape().origin + glm::dvec3(1, 0, 0);
    for (const pipeline::CameraPose& pose : model_.look.cameras)
      if (pose.name == model_.look.main_view) from = pose.camera.center();
    return render::turntable(model_.shape(), model_.look.up, from, options, size_.width,
                             size_.height);
  }

  RgbImage draw(const render::Shot& shot) {
    return rasterizer_->draw(shot.camera, shot.window, size_.width, size_.height, look_,
                             background_);
  }

  /// Of the view that was asked for; else as the film begins. Without a size, a view's picture is
  /// as large as its photograph.
  RgbImage still(const RenderArguments& a, bool sized) {
    if (!camera_) return draw(turn(a.turn).front());
    const Size given = size_;
    if (!sized) {
      const Intrinsics& k = camera_->intrinsics;
      const double shrink = std::min(1.0, double(kLargestSide) / std::max(k.width, k.height));
      size_ = {std::max(1, int(std::lround(shrink * k.width))),
               std::max(1, int(std::lround(shrink * k.height)))};
    }
    const RgbImage picture =
        draw(render::seen_from(model_.shape(), *camera_, size_.width, size_.height));
    size_ = given;
    return picture;
  }

 private:
  Size size_;
  render::Look look_;
  render::Colour background_;
  pipeline::ResultModel model_;
  std::optional<Camera> camera_;
  std::unique_ptr<gpu::Context> context_;
  std::unique_ptr<render::Rasterizer> rasterizer_;
};

void draw_film(const RenderArguments& a, Painter& painter, io::Film& film, Progress& progress) {
  progress.stage("film", 1);
  const std::vector<render::Shot> shots = painter.turn(a.turn);
  for (std::size_t i = 0; i < shots.size(); ++i) {
    progress.check_cancelled();
    film.add(painter.draw(shots[i]));
    progress.update(double(i + 1) / double(shots.size()));
  }
  film.finish();
}

void run_render(const RenderArguments& a, bool sized) {
  check(a);
  const Size size = read_size(a.size);
  Painter painter(a, size);
  check_process_limits(a.device.threads);
  TerminalProgress progress((a.turntable ? 1 : 0) + kReadWeight + (a.picture ? kStillWeight : 0));
  // What can fail at once does so before the work; nothing is made in a folder for no result.
  progress.stage("model", kReadWeight);
  painter.load(a);
  std::unique_ptr<io::Film> film;
  if (a.turntable) {
    if (!a.turntable->empty())
      make_folder(std::filesystem::path(*a.turntable).parent_path(), "--turntable");
    film = io::open_film(*a.turntable, {size.width, size.height, a.turn.frames, a.rate}, progress);
  }
  std::optional<AtomicFile> picture;
  if (a.picture) {
    make_folder(std::filesystem::path(*a.picture).parent_path(), "--picture");
    picture.emplace(*a.picture);
    progress.stage("picture", kStillWeight);
    io::write_png(*picture, painter.still(a, sized));
  }
  if (film) draw_film(a, painter, *film, progress);
  if (picture) picture->commit();
  progress.finish();
  if (a.picture) std::printf("%s\n", a.picture->c_str());
  if (a.turntable) std::printf("%s\n", a.turntable->c_str());
}

}  // namespace

void add_render(CLI::App& app) {
  auto a = std::make_shared<RenderArguments>();
  CLI::App* c = add_command(app, "render");
  c->add_option("DIR", a->folder, "folder that 'photohull reconstruct' wrote")->required();
  c->add_option("--turntable", a->turntable,
                "film of the turning model: NAME.mp4 (or .mov, .mkv, .webm, .gif, .webp), "
                "NAME_%04d.png or a folder for a PNG file each picture");
  c->add_option("--picture", a->picture, "PNG file: a still, as the film begins or from --camera");
  c->add_option("--camera", a->camera,
                "still from the camera of a photograph: its name, or its index in report.json");
  CLI::Option* size = c->add_option(
      "--size", a->size,
      "WIDTHxHEIGHT in pixels; with --camera that of the photograph where it is not given");
  size->capture_default_str();
  add_flags_of(*c, a->turn);
  c->add_option("--rate", a->rate, "pictures a second of films")
      ->check(CLI::Range(1.0, 120.0))
      ->capture_default_str();
  c->add_flag("--clay", a->clay, "shading without colour");
  c->add_option("--background", a->background, "grey, white, black or #RRGGBB")
      ->capture_default_str();
  add_flags_of(*c, a->device);
  c->footer(
      "Draws the textured mesh.glb where the result has one, else mesh.ply with its vertices' "
      "colours.\n"
      "The model turns about what is upward in the photographs. Films need the program ffmpeg.\n\n"
      "Examples:\n"
      "  photohull render out/temple --turntable temple.mp4\n"
      "  photohull render out/temple --turntable 'frames/%04d.png' --frames 36 --size 640x480\n"
      "  photohull render out/temple --camera 3 --picture view3.png --clay --background white");
  c->callback([a, size] { run_render(*a, size->count() > 0); });
}

}  // namespace photohull::cli

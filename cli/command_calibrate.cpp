#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "calib/calibrate_board.h"
#include "commands.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/parse_name.h"
#include "io/image_file.h"
#include "terminal_progress.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct Arguments {
  std::vector<std::string> images;
  std::string board = "chess", lens = "brown", out, coverage;
  BoardSpec spec;
  bool turntable = false, json = false;
};

/// The files given, and the pictures of the folders given.
std::vector<fs::path> list_images(const std::vector<std::string>& given) {
  std::vector<fs::path> images;
  for (const std::string& path : given) {
    std::error_code failure;
    if (!fs::is_directory(path, failure)) {
      images.emplace_back(path);
      continue;
    }
    std::vector<fs::path> inside;
    for (const auto& entry : fs::directory_iterator(path, failure)) {
      std::string e = entry.path().extension().string();
      std::transform(e.begin(), e.end(), e.begin(),
                     [](unsigned char c) { return std::tolower(c); });
      if (e == ".png" || e == ".jpg" || e == ".jpeg" || e == ".tif" || e == ".tiff" || e == ".exr")
        inside.push_back(entry.path());
    }
    if (failure) throw Error(concat(path, ": cannot be listed (", failure.message(), ")"));
    std::sort(inside.begin(), inside.end());
    images.insert(images.end(), inside.begin(), inside.end());
  }
  if (images.empty())
    throw Error("no picture was found; give images or the folder that holds them");
  return images;
}

ordered_json vector_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

ordered_json to_json(const Arguments& a, const std::vector<BoardView>& views,
                     const Calibration& c) {
  const Intrinsics& k = c.intrinsics;
  ordered_json j;
  j["image_width"] = k.width;
  j["image_height"] = k.height;
  j["camera_matrix"] = {{k.fx, 0.0, k.cx}, {0.0, k.fy, k.cy}, {0.0, 0.0, 1.0}};
  j["model"] = a.lens;
  j["distortion_coefficients"] = c.distortion.coefficients;
  j["rms"] = c.all_rms;
  j["focal_sigma"] = c.focal_sigma;
  j["principal_point_sigma"] = c.principal_sigma;
  if (c.turntable)
    j["turntable"] = {{"axis", vector_json(c.turntable->direction)},
                      {"point", vector_json(c.turntable->point)},
                      {"axis_sigma_degrees", c.turntable->direction_sigma},
                      {"angle_sigma_degrees", c.turntable->angle_sigma}};
  j["views"] = ordered_json::array();
  for (std::size_t i = 0; i < views.size(); ++i) {
    ordered_json view = {{"name", views[i].name},
                         {"points", views[i].points.size()},
                         {"rms", std::isnan(c.rms[i]) ? ordered_json() : ordered_json(c.rms[i])},
                         {"left_out", bool(c.left_out[i])}};
    if (!c.left_out[i]) {
      const glm::dmat3& r = c.cam_from_board[i].rotation;
      view["R"] = {
          {r[0][0], r[1][0], r[2][0]}, {r[0][1], r[1][1], r[2][1]}, {r[0][2], r[1][2], r[2][2]}};
      view["t"] = vector_json(c.cam_from_board[i].translation);
      if (c.turntable) view["angle_degrees"] = c.turntable->angles[i];
    }
    j["views"].push_back(view);
  }
  return j;
}

void print_summary(const std::vector<BoardView>& views, const Calibration& c) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i].points.empty())
      std::printf("%-32s board not found\n", views[i].name.c_str());
    else
      std::printf("%-32s %7.3f px over %zu points%s\n", views[i].name.c_str(), c.rms[i],
                  views[i].points.size(), c.left_out[i] ? ", left out" : "");
  }
  const Intrinsics& k = c.intrinsics;
  std::printf("focal length     %.3f, %.3f +- %.3f px\n", k.fx, k.fy, c.focal_sigma);
  std::printf("principal point  %.3f, %.3f +- %.3f px\n", k.cx, k.cy, c.principal_sigma);
  std::printf("reprojection     %.4f px rms\n", c.all_rms);
  if (c.turntable)
    std::printf("axis             %.6f %.6f %.6f +- %.4f degrees through %g %g %g\n",
                c.turntable->direction.x, c.turntable->direction.y, c.turntable->direction.z,
                c.turntable->direction_sigma, c.turntable->point.x, c.turntable->point.y,
                c.turntable->point.z);
}

void run(const Arguments& a) {
  BoardSpec spec = a.spec;
  spec.kind = parse_name("--board", a.board,
                         std::array{BoardKind::kChess, BoardKind::kCharuco, BoardKind::kCircles});
  spec.validate();
  CalibrateOptions options;
  options.turntable = a.turntable;
  options.lens = parse_name("--lens", a.lens,
                            std::array{LensModel::kPinhole, LensModel::kBrown, LensModel::kRational,
                                       LensModel::kFisheye});
  if (a.out.empty()) throw UsageError("--out is empty: give the JSON file for the calibration");
  const std::vector<fs::path> images = list_images(a.images);
  TerminalProgress progress(1);
  progress.stage("boards", 1);
  std::vector<BoardView> views;
  for (std::size_t i = 0; i < images.size(); ++i) {
    progress.check_cancelled();
    progress.update(double(i) / double(images.size()));
    views.push_back(find_board(io::read_image(images[i]), spec, images[i].filename().string()));
  }
  progress.finish();
  const Calibration calibration = calibrate(views, options);
  const std::string text = to_json(a, views, calibration).dump(1) + "\n";
  write_atomically(a.out, text);
  if (!a.coverage.empty()) {
    const ColourImage picture = coverage_picture(views, calibration);
    io::write_png(a.coverage, picture.width, picture.height, 4, picture.bytes);
  }
  if (a.json)
    std::fputs(text.c_str(), stdout);
  else
    print_summary(views, calibration);
}

}  // namespace

void add_calibrate(CLI::App& app) {
  auto a = std::make_shared<Arguments>();
  CLI::App* c = app.add_subcommand("calibrate", "find a camera's lens from photographs of a board");
  c->add_option("images", a->images, "photographs, or folders of them")->required();
  c->add_option("--out", a->out, "JSON file for the calibration")->required();
  c->add_option("--board", a->board, "chess, charuco or circles")->capture_default_str();
  c->add_option("--columns", a->spec.columns, "inner corners, charuco: squares, circles: dots")
      ->capture_default_str();
  c->add_option("--rows", a->spec.rows, "the same downwards")->capture_default_str();
  c->add_option("--square", a->spec.square, "distance of neighbouring corners or dots")
      ->capture_default_str();
  c->add_option("--marker", a->spec.marker, "charuco: a marker's side as a share of a square's")
      ->capture_default_str();
  c->add_option("--dictionary", a->spec.dictionary, "charuco: number of OpenCV's dictionary")
      ->capture_default_str();
  c->add_option("--lens", a->lens, "pinhole, brown, rational or fisheye")->capture_default_str();
  c->add_flag("--turntable", a->turntable,
              "a fixed camera and a board that turns: find their common axis and the angles");
  c->add_option("--coverage", a->coverage, "PNG of where in the frame the board was seen");
  c->add_flag("--json", a->json, "print the calibration instead of a summary");
  c->footer(
      "Views whose error is far from the others' are named and left out.\n\n"
      "Examples:\n"
      "  photohull calibrate boards/ --columns 9 --rows 6 --square 0.025 --out calib.json\n"
      "  photohull calibrate table/*.jpg --board charuco --columns 8 --rows 6 --turntable --out "
      "t.json");
  c->callback([a] { run(*a); });
}

}  // namespace photohull::cli

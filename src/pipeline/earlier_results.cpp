#include "pipeline/earlier_results.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.h"
#include "core/option_word.h"
#include "pipeline/identity_text.h"
#include "pipeline/input_hashes.h"
#include "pipeline/read_result.h"
#include "views/photometric_samples.h"
#include "volume/write_vdb.h"

namespace photohull::pipeline {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr double kSame = 1e-9;  // relative: two texts of one number
constexpr double kProportions = 1e-3;

bool same(double a, double b) { return std::abs(a - b) <= kSame * std::max(1.0, std::abs(b)); }

bool same(const Camera& a, const Camera& b) {
  const Intrinsics &k = a.intrinsics, &l = b.intrinsics;
  bool alike = same(k.fx, l.fx) && same(k.fy, l.fy) && same(k.skew, l.skew) && same(k.cx, l.cx) &&
               same(k.cy, l.cy);
  for (int i = 0; i < 3; ++i) {
    alike = alike && same(a.cam_from_world.translation[i], b.cam_from_world.translation[i]);
    for (int j = 0; j < 3; ++j)
      alike = alike && same(a.cam_from_world.rotation[i][j], b.cam_from_world.rotation[i][j]);
  }
  return alike;
}

/// The pose's camera for a photograph that was read at another size.
Camera at_size(const CameraPose& pose, const Intrinsics& size, const ResultRig& rig) {
  Camera out = pose.camera;
  Intrinsics& k = out.intrinsics;
  const double x = double(size.width) / k.width, y = double(size.height) / k.height;
  if (std::abs(x / y - 1) > kProportions)
    throw Error(concat(option_word("rig", rig.folder.string()), ": ", pose.name, " has ", k.width,
                       " x ", k.height, " pixels there and ", size.width, " x ", size.height,
                       " here; give a result of the same cameras"));
  k.width = size.width, k.height = size.height;
  k.fx *= x, k.fy *= y, k.skew *= x;
  k.cx = (k.cx + 0.5) * x - 0.5, k.cy = (k.cy + 0.5) * y - 0.5;
  return out;
}

/// Moves both of a view's cameras, that of the photograph and the pinhole that it was made of it.
void take(const Camera& found, PreparedView& view) {
  Intrinsics &k = view.camera.intrinsics, &source = view.source.camera.intrinsics;
  k.fx *= found.intrinsics.fx / source.fx, k.fy *= found.intrinsics.fy / source.fy;
  k.skew += found.intrinsics.skew - source.skew;
  k.cx += found.intrinsics.cx - source.cx, k.cy += found.intrinsics.cy - source.cy;
  view.source.camera = found;
  view.camera.cam_from_world = found.cam_from_world;
}

[[noreturn]] void throw_damaged(const ResultRig& rig) {
  throw Error(concat((rig.folder / "report.json").string(),
                     ": \"photometric\" is damaged; reconstruct again"));
}

}  // namespace

EarlierResults read_earlier(const ReconstructOptions& options) {
  EarlierResults out;
  if (!options.rig_folder().empty()) out.rig = read_rig(options.rig_folder());
  if (options.follow.empty()) return out;
  SparseVolume volume = read_vdb_surface(options.follow / "volume.vdb");
  if (options.part) {
    WholeReport report = read_whole_report(options.follow);
    out.part = cut_part(volume, report.box, *options.part, options.finer);
    if (!report.hull_trust.empty())
      out.part->hull_trust = report.hull_trust[std::size_t(options.finer)];
    out.verdict = std::move(report.verdict);
  } else {
    out.before = {std::move(volume), read_report(options.follow).followed};
  }
  return out;
}

ResultRig read_rig(const fs::path& folder) {
  ResultReport report = read_report(folder);
  return {folder, std::move(report.look.cameras), std::move(report.photometric)};
}

std::string digest_of(const ResultRig& rig) {
  std::ostringstream text;
  text << std::setprecision(kIdentityDigits);
  for (const CameraPose& pose : rig.cameras) {
    text << std::quoted(pose.name) << '\n';
    add_camera(pose.camera, text);
  }
  text << rig.photometric;
  const std::string all = text.str();
  return digest_of({reinterpret_cast<const std::uint8_t*>(all.data()), all.size()});
}

std::vector<PreparedView> with_cameras_of(const ResultRig& rig, std::vector<PreparedView> views,
                                          Progress& progress) {
  std::string unknown;
  for (PreparedView& view : views) {
    const auto pose = std::ranges::find(rig.cameras, view.name, &CameraPose::name);
    if (pose == rig.cameras.end()) {
      unknown += (unknown.empty() ? "" : ", ") + view.name;
      continue;
    }
    const Camera found = at_size(*pose, view.source.camera.intrinsics, rig);
    if (!same(found, view.source.camera)) take(found, view);
  }
  if (!unknown.empty())
    progress.warn(concat(option_word("rig", rig.folder.string()), ": ", unknown,
                         " took no part there, so that camera and gains are as given"));
  return views;
}

MeasuredGains gains_of(const ResultRig& rig, const std::vector<PreparedView>& views) {
  MeasuredGains out{{{}, concat("photometric: gains as in ", rig.folder.string())}, std::nullopt};
  try {
    ordered_json all = rig.photometric.empty() ? ordered_json({{"used", false}})
                                               : ordered_json::parse(rig.photometric);
    all["taken_from"] = rig.folder.string();
    out.findings.json = all.dump();
    if (!all.at("used").get<bool>()) return out;
    const std::vector<int> lenses = shared_lenses(frames_of(views));
    PhotometricCalibration gains;
    gains.lens_count = 1 + *std::ranges::max_element(lenses);
    gains.vignetting.assign(std::size_t(gains.lens_count), 0);
    gains.vignetting_sigma = gains.vignetting;
    gains.views.resize(views.size());
    gains.solved = true;
    for (const ordered_json& view : all.at("views")) {
      const auto here =
          std::ranges::find(views, view.at("name").get<std::string>(), &PreparedView::name);
      if (here == views.end()) continue;
      const std::size_t i = std::size_t(here - views.begin());
      for (int channel = 0; channel < 3; ++channel) {
        double& gain = gains.views[i].gain[channel];
        gain = view.at("gain").at(std::size_t(channel)).get<double>();
        if (!(gain > 0)) throw_damaged(rig);
      }
      gains.views[i].solved = view.at("solved").get<bool>();
      double& vignetting = gains.vignetting[std::size_t(lenses[i])];
      vignetting =
          all.at("lenses").at(view.at("lens").get<std::size_t>()).at("vignetting").get<double>();
      if (!(vignetting < 1)) throw_damaged(rig);
    }
    out.gains = std::move(gains);
  } catch (const nlohmann::json::exception&) {
    throw_damaged(rig);
  }
  return out;
}

}  // namespace photohull::pipeline

#include "pipeline/photometric.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/option_word.h"
#include "views/photometric_check.h"
#include "views/photometric_samples.h"

namespace photohull::pipeline {
namespace {

constexpr double kPatch = 2;  // voxels: about the error of a surface, and so large are the windows

// Of the quick look: gains of 36 views then come out to 1 or 2 %, in a fiftieth of the time.
constexpr std::size_t kCheckPoints = 600, kCheckPointsAView = 8;

using nlohmann::ordered_json;

ordered_json array_of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

/// Area-weighted means of the faces' normals.
TriMesh with_normals(TriMesh mesh) {
  mesh.normals.assign(mesh.positions.size(), glm::vec3(0));
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::vec3 n =
        glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
    for (const std::uint32_t i : {a, b, c}) mesh.normals[i] += n;
  }
  for (glm::vec3& n : mesh.normals)
    if (const float length = glm::length(n); length > 0) n /= length;
  return mesh;
}

std::string to_json(const PhotometricCalibration& c, const std::vector<PreparedView>& views,
                    const std::vector<int>& lenses, bool used) {
  ordered_json j = {{"solved", c.solved},
                    {"significant", c.significant},
                    {"used", used},
                    {"points", c.points},
                    {"samples", c.samples},
                    {"disagreement_before", c.disagreement_before},
                    {"disagreement_after", c.disagreement_after},
                    {"held_out_samples", c.held_out_samples},
                    {"rms_gain", c.rms_gain},
                    {"rms_gain_sigmas", c.rms_sigmas}};
  j["lenses"] = ordered_json::array();
  for (std::size_t l = 0; l < c.vignetting.size(); ++l)
    j["lenses"].push_back({{"vignetting", c.vignetting[l]}, {"sigma", c.vignetting_sigma[l]}});
  j["views"] = ordered_json::array();
  for (std::size_t i = 0; i < c.views.size(); ++i)
    j["views"].push_back({{"name", views[i].name},
                          {"gain", array_of(c.views[i].gain)},
                          {"sigma", array_of(c.views[i].sigma)},
                          {"samples", c.views[i].samples},
                          {"solved", c.views[i].solved},
                          {"lens", lenses[i]}});
  return j.dump(2, ' ', false, ordered_json::error_handler_t::replace);
}

std::string to_line(const PhotometricCalibration& c, bool used) {
  if (!c.solved) return "photometric: too few surface points that several views see";
  double low = INFINITY, high = 0, lost = 0;
  for (const ViewGain& view : c.views)
    for (int channel = 0; channel < 3; ++channel) {
      low = std::min(low, view.gain[channel]);
      high = std::max(high, view.gain[channel]);
    }
  for (const double v : c.vignetting) lost = std::max(lost, v);
  char text[200];
  std::snprintf(text, sizeof text,
                "photometric: gains %.3f to %.3f, corners lose %.0f %%; colours differ by %.1f %%, "
                "corrected by %.1f %%: %s",
                low, high, 100 * lost, 100 * c.disagreement_before, 100 * c.disagreement_after,
                used ? "corrected" : "left as they are");
  return text;
}

}  // namespace

const char* to_string(Photometric photometric) {
  switch (photometric) {
    case Photometric::kOff:
      return "off";
    case Photometric::kAuto:
      return "auto";
    case Photometric::kOn:
      return "on";
  }
  return "?";
}

std::optional<PhotometricOutcome> find_alike(const TriMesh& mesh, double voxel_size,
                                             double noise_sigma,
                                             const std::vector<PreparedView>& views,
                                             const Progress& progress) {
  const bool complete = mesh.normals.size() == mesh.positions.size();
  const PhotometricCheck c = check_photometric(
      sample_photometric(complete ? mesh : with_normals(mesh), kPatch * voxel_size, views,
                         frames_of(views), noise_sigma, progress,
                         std::max(kCheckPoints, kCheckPointsAView * views.size())),
      int(views.size()));
  if (c.differ || c.views < 2) return {};
  PhotometricOutcome out;
  out.json = ordered_json({{"used", false},
                           {"checked",
                            {{"points", c.points},
                             {"samples", c.samples},
                             {"views", c.views},
                             {"rms_gain", c.rms_gain},
                             {"noise", c.noise},
                             {"profit", c.profit},
                             {"vignetting", c.vignetting},
                             {"vignetting_noise", c.vignetting_noise}}}})
                 .dump();
  char text[200];
  std::snprintf(text, sizeof text,
                "photometric: gains differ by %.1f %% (their estimate is good to %.1f %%): left as "
                "they are",
                100 * c.rms_gain, 100 * c.noise);
  out.line = text;
  return out;
}

PhotometricOutcome measure_photometric(Photometric photometric, const TriMesh& mesh,
                                       double voxel_size, double noise_sigma,
                                       const std::vector<PreparedView>& views,
                                       const Progress& progress) {
  PHOTOHULL_CHECK(photometric != Photometric::kOff);
  const std::vector<PhotometricFrame> frames = frames_of(views);
  const std::vector<int> lenses = shared_lenses(frames);
  PhotometricOutcome out;
  const bool complete = mesh.normals.size() == mesh.positions.size();
  out.calibration = calibrate_photometric(
      sample_photometric(complete ? mesh : with_normals(mesh), kPatch * voxel_size, views, frames,
                         noise_sigma, progress),
      lenses, {}, progress);
  const PhotometricCalibration& c = out.calibration;
  out.used = c.solved && (photometric == Photometric::kOn || c.pays);
  out.json = to_json(c, views, lenses, out.used);
  out.line = to_line(c, out.used);
  if (photometric == Photometric::kOn && !c.solved)
    out.warning = concat(option_word("photometric", "on"),
                         ": too few surface points are seen by several views to measure gains; "
                         "colours stay as photographed");
  else if (out.used) {
    std::string names;
    int count = 0;
    for (std::size_t i = 0; i < c.views.size(); ++i)
      if (!c.views[i].solved && ++count <= 5) names += (names.empty() ? "" : ", ") + views[i].name;
    if (count > 0)
      out.warning = concat(count,
                           " views show too little of the surface to measure their gains, "
                           "and keep theirs: ",
                           names, count > 5 ? ", ..." : "");
  }
  return out;
}

std::vector<PreparedView> divide_by_gains(std::vector<PreparedView> views,
                                          const PhotometricCalibration& gains) {
  const std::vector<PhotometricFrame> frames = frames_of(views);
  apply_photometric(gains, frames, shared_lenses(frames), views);
  return views;
}

}  // namespace photohull::pipeline

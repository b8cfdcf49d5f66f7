#include "sample_page.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "io/encode_jpeg.h"

namespace photohull::test {
namespace {

using nlohmann::json;

constexpr int kViews = 6;
constexpr double kPi = std::numbers::pi;

std::string name_of(int view) { return concat("view", view, view == 2 ? kHostileName : ".jpg"); }

glm::vec3 wrinkled(const glm::dvec3& direction) {
  const double radius = 1 + 0.06 * std::sin(9 * direction.x) * std::cos(7 * direction.y) +
                        0.02 * std::sin(40 * direction.z);
  return glm::vec3(radius * direction);
}

}  // namespace

TriMesh wrinkled_ball(int rings) {
  TriMesh mesh;
  mesh.origin = {1000, 0, 0};
  const auto add = [&](double polar, double azimuth) {
    const glm::dvec3 d(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                       std::cos(polar));
    mesh.positions.push_back(wrinkled(d));
    mesh.normals.emplace_back(d);
    mesh.colours.emplace_back(0.5 + 0.4 * std::sin(12 * d.x), 0.4 + 0.3 * std::cos(9 * d.y),
                              0.5 + 0.3 * d.z);
    mesh.confidence.push_back(d.z < -0.8 ? 0.0f : float(0.6 + 0.4 * d.z));
  };
  const auto n = std::uint32_t(rings);
  for (std::uint32_t i = 0; i <= n; ++i)
    for (std::uint32_t j = 0; j < n; ++j) add(kPi * (i + 0.01) / (n + 0.02), 2 * kPi * j / n);
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * n + j, b = i * n + (j + 1) % n, c = a + n, d = b + n;
      mesh.triangles.push_back({a, c, d});
      mesh.triangles.push_back({a, d, b});
    }
  return mesh;
}

std::vector<page::ShownView> ring_of_views() {
  std::vector<page::ShownView> views;
  for (int i = 0; i < kViews; ++i) {
    const double a = 2 * kPi * i / kViews;
    // It stands 4 units from the ball, which it looks at; world z is up.
    const glm::dvec3 back(std::cos(a), std::sin(a), 0), right(-std::sin(a), std::cos(a), 0);
    Camera camera;
    camera.intrinsics = {200, 150, 220, 220, 0, 99.5, 74.5};
    camera.cam_from_world.rotation = glm::transpose(glm::dmat3(right, glm::dvec3(0, 0, -1), -back));
    const glm::dvec3 centre = glm::dvec3(1000, 0, 0) + 4.0 * back;
    camera.cam_from_world.translation = -(camera.cam_from_world.rotation * centre);
    std::vector<std::uint8_t> rgb(200 * 150 * 3, std::uint8_t(40 + 30 * i));
    views.push_back({name_of(i), camera, io::encode_jpeg(200, 150, rgb, 80)});
  }
  return views;
}

std::string sample_report(const TriMesh& mesh) {
  json views = json::array(), stages = json::array();
  for (int i = 0; i < kViews; ++i)
    views.push_back({{"name", name_of(i)},
                     {"residual", 0.3 + 0.1 * i},
                     {"matches", 50},
                     {"pixel_size", 0.018},
                     {"told", 100},
                     {"disagreeing", i == 4 ? 70 : 5},
                     {"missed", 0.001 * i},
                     {"excess", 0.002}});
  for (const char* name : {"scene", "hull", "refine", kHostileName})
    stages.push_back({{"name", name},
                      {"wall_seconds", 0.5},
                      {"cpu_seconds", 0.9},
                      {"samples", 0},
                      {"peak_memory_bytes", 1 << 28}});
  const std::string hostile = kHostileName;
  return json({{"photohull", "0"},
               {"device", "none"},
               {"scene",
                {{"path", "/scans/" + hostile}, {"format", "transforms"}, {"views", kViews}}},
               {"photographs",
                {{"listed", kViews + 1},
                 {"left_out", {{{"name", hostile}, {"reason", "missing"}, {"detail", hostile}}}}}},
               {"options", {{"method", "refine"}, {"masks", hostile}}},
               {"box", {{"min", {999, -1, -1}}, {"max", {1001, 1, 1}}, {"source", hostile}}},
               {"image_scale", {{"smallest", 0.5}, {"largest", 1}}},
               {"masks",
                {{"source", "mask files"}, {"confidence", 0.7}, {"left_out", json::array()}}},
               {"left_out", json::array()},
               {"verdict",
                {{"level", "doubtful"},
                 {"reasons",
                  {"the views " + name_of(2) + " and " + name_of(4) +
                       " disagree with the rest: " + hostile,
                   "no view sees 60 % of the surface: photograph it from other sides"}},
                 {"notes", json::array()},
                 {"coverage", "40 % of the surface is seen"},
                 {"signals", {{"pixel_size", 0.018}, {"half_percent", 0.02}}},
                 {"views", views}}},
               {"grid", {{"voxel_size", 0.02}, {"voxels", {100, 100, 100}}}},
               {"stages", stages},
               {"mesh",
                {{"vertices", mesh.positions.size()},
                 {"triangles", mesh.triangles.size()},
                 {"unseen_share", 0.1}}},
               {"wall_seconds", 2.0},
               {"cpu_seconds", 3.6},
               {"peak_memory_bytes", 1 << 28},
               {"warnings", {hostile}},
               {"files", {"mesh.ply", "report.json"}}})
      .dump();
}

/// Squares of 32 texels, red and green by turns along x, blue growing along y.
std::vector<std::uint8_t> sample_texture(int edge) {
  std::vector<std::uint8_t> rgb;
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x) {
      const bool odd = x / 32 % 2 == 1;
      rgb.insert(rgb.end(), {std::uint8_t(odd ? 30 : 220), std::uint8_t(odd ? 200 : 40),
                             std::uint8_t(255 * y / edge)});
    }
  return io::encode_jpeg(edge, edge, rgb, 80);
}

page::Shown textured_shown(const TriMesh& mesh) {
  page::Shown shown = sample_shown(mesh);
  std::vector<glm::vec2> places;
  for (const glm::vec3& p : mesh.positions)
    places.emplace_back(0.5 + 0.45 * double(p.x) / 1.1, 0.5 + 0.45 * double(p.z) / 1.1);
  shown.model = page::encode_model(mesh, sample_layers(mesh), places);
  shown.texture = sample_texture(1024);
  return shown;
}

page::Shown sample_shown(const TriMesh& mesh) {
  return {page::encode_model(mesh, sample_layers(mesh)), ring_of_views(), {}, {0, 0, 1}, 1};
}

std::vector<page::Layer> sample_layers(const TriMesh& mesh) {
  std::vector<float> views, disagreement;
  for (const float confidence : mesh.confidence) {
    views.push_back(std::round(6 * confidence));
    disagreement.push_back(confidence > 0 ? 0.2f * (1 - confidence)
                                          : std::numeric_limits<float>::quiet_NaN());
  }
  return {{"confidence", mesh.confidence, 1},
          {"views", views, 254},
          {"disagreement", disagreement, 0.25}};
}

}  // namespace photohull::test

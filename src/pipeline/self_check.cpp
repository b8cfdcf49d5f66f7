#include "pipeline/self_check.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "assess/explained.h"
#include "assess/silhouette_check.h"
#include "assess/surface_probes.h"
#include "carving/fit_grid.h"
#include "core/photographed.h"
#include "masks/silhouette.h"
#include "mesh/join_meshes.h"
#include "pipeline/subject.h"
#include "raycast/ray_scene.h"

namespace photohull::pipeline {
namespace {

constexpr std::size_t kProbes = 2000;
constexpr double kLift = 0.75;          // voxels above the surface, to look past its own facets
constexpr double kFar = 0.005;          // of the surface's diagonal
constexpr double kCoarsest = 2;         // times that: pixels of views that tell whether it is far
constexpr double kBeyondAtAll = 0.002;  // of a silhouette
constexpr double kContour = 2;          // pixels beside a silhouette's contour that do not count
constexpr double kContourVoxels = 1;    // and voxels

double diagonal(const TriMesh& mesh) {
  glm::vec3 low = mesh.positions.front(), high = low;
  for (const glm::vec3& p : mesh.positions) low = glm::min(low, p), high = glm::max(high, p);
  return glm::distance(glm::dvec3(low), glm::dvec3(high));
}

double share_of(std::span<const assess::SurfaceProbe> probes, auto&& holds) {
  return double(std::count_if(probes.begin(), probes.end(), holds)) /
         double(std::max<std::size_t>(1, probes.size()));
}

/// The mask, in doubt where nothing was photographed.
Mask doubted_beside_photograph(const PreparedView& view) {
  constexpr std::uint8_t kInDoubt = 127;
  Mask mask = view.mask;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      if (!is_photographed(view.image, x, y))
        mask.coverage[std::size_t(y) * std::size_t(mask.width) + std::size_t(x)] = kInDoubt;
  return mask;
}

std::vector<assess::SilhouetteFit> compare_silhouettes(const CheckedResult& result,
                                                       const RayScene& rays,
                                                       std::span<const Camera> cameras,
                                                       assess::Signals& s) {
  // What a view's own mask shows is to be covered, whatever was put into its silhouette since.
  std::vector<SilhouetteDistance> given(cameras.size());
  std::vector<Mask> masks(cameras.size());
  std::vector<assess::CheckedSilhouette> checked(cameras.size());
  tbb::parallel_for(std::size_t(0), cameras.size(), [&](std::size_t i) {
    const ViewSilhouette& silhouette = result.views[i].silhouette;
    if (silhouette.distance.pixels.empty()) return;
    const Mask& mask = result.views[i].mask;
    if (result.views[i].image.has_alpha) masks[i] = doubted_beside_photograph(result.views[i]);
    checked[i] = {&silhouette.distance, &silhouette.distance, &silhouette.lines,
                  mask.empty()       ? nullptr
                  : masks[i].empty() ? &mask
                                     : &masks[i]};
    if (silhouette.widened.empty()) return;
    given[i] = silhouette_distance(mask);
    checked[i].given = &given[i];
  });
  const double tolerance =
      std::max(kContour, s.pixel_size > 0 ? kContourVoxels * result.voxel_size / s.pixel_size : 0);
  auto fits = assess::check_silhouettes(rays, *result.box, cameras, checked, tolerance);
  int known = 0;
  for (const assess::SilhouetteFit& fit : fits) {
    known += fit.foreground > 0;
    s.beyond_views += fit.beyond_box > kBeyondAtAll;
    s.missed += fit.missed, s.excess += fit.excess, s.beyond_box += fit.beyond_box;
    s.missed_width += fit.missed * fit.missed_width;
  }
  if (s.missed > 0) s.missed_width /= s.missed;
  if (known > 0)
    s.missed /= known, s.excess /= known, s.beyond_box /= known, s.beyond_views /= known;
  return fits;
}

/// The photographs by all that was made, its surroundings too.
assess::Explained explain(const CheckedResult& result, const RayScene& rays,
                          const assess::ExplainOptions& options) {
  if (!result.around || result.around->triangles.empty())
    return assess::explain_photographs(*result.mesh, rays, *result.box, result.views, options);
  TriMesh all = *result.mesh;
  append_mesh(*result.around, all);
  return assess::explain_photographs(all, RayScene(all), *result.around_box, result.views, options);
}

}  // namespace

assess::Signals gather_signals(const CheckedResult& result,
                               std::vector<assess::SilhouetteFit>* fits) {
  const TriMesh& mesh = *result.mesh;
  std::vector<Camera> cameras;
  for (const PreparedView& view : result.views) cameras.push_back(view.camera);
  const RayScene rays(mesh);
  const std::vector<assess::SurfaceProbe> probes =
      assess::probe_surface(mesh, rays, cameras, kProbes, kLift * result.voxel_size);

  assess::Signals s;
  s.views = int(result.views.size());
  s.hull = result.hull;
  s.cameras_within =
      double(std::ranges::count_if(
          cameras, [&](const Camera& camera) { return result.box->contains(camera.center()); })) /
      double(cameras.size());
  s.stems = result.stems;
  s.stems_restored = result.stems_restored;
  s.pixel_size = carving::pixel_footprint(*result.box, cameras);
  s.voxel_size = result.voxel_size;
  const glm::dvec3 box = result.box->size();
  s.resolution = int(std::lround(std::max({box.x, box.y, box.z}) / result.voxel_size));
  s.far = kFar * diagonal(mesh);
  s.cameras_moved = result.cameras_moved;
  s.cameras_moved_alike = result.cameras_moved_alike;
  s.mask_confidence = result.mask_confidence;
  s.contradiction = result.contradiction;
  s.masks = result.bounded;
  s.hull_beyond = result.share_beyond;
  for (const assess::SurfaceProbe& p : probes)
    s.mean_confidence += double(p.confidence) / double(probes.size());
  s.unsure = share_of(probes, [](const auto& p) { return p.confidence < 0.5f; });
  s.unseen = share_of(probes, [](const auto& p) { return p.views.empty(); });
  s.few_views = share_of(probes, [](const auto& p) { return p.views.size() < 3; });
  s.at_box = share_of(probes, [&](const auto& p) {
    const glm::dvec3 inside = glm::min(p.point - result.box->min, result.box->max - p.point);
    return !p.views.empty() && std::min({inside.x, inside.y, inside.z}) < result.voxel_size;
  });
  if (s.masks) {
    auto filled = compare_silhouettes(result, rays, cameras, s);
    if (fits) *fits = std::move(filled);
  }
  const double noise = 255 * result.noise_sigma;  // square roots are close to sRGB
  s.common = result.common;
  if (!s.hull && s.pixel_size > 0)
    (s.masks ? s.compared : s.explained) =
        explain(result, rays, {result.voxel_size, s.pixel_size, noise, s.masks});
  assess::MatchOptions options;
  options.near = result.voxel_size;
  options.far = s.far;
  options.coarsest = kCoarsest * s.far;
  options.noise = noise;
  s.match = assess::match_probes(probes, result.views, distances_of(result.views), options);
  return s;
}

namespace {

using nlohmann::ordered_json;

ordered_json explained_json(const assess::Explained& e, std::span<const PreparedView> views) {
  using assess::Place;
  ordered_json j = {{"places", e.looked_at()},
                    {"plain", e.count(Place::kPlain) / std::max(1.0, double(e.looked_at()))},
                    {"told", e.told()},
                    {"explained", e.explained()},
                    {"disagreeing", e.share_told(Place::kDisagreeing)},
                    {"alone", e.share_told(Place::kAlone)},
                    {"missed", e.share_told(Place::kMissed)},
                    {"bare", e.share_textured(Place::kBare)},
                    {"cut", e.share_textured(Place::kCut)},
                    {"beyond", e.share_textured(Place::kBeyond)},
                    {"behind", e.share_behind()}};
  for (std::size_t i = 0; i < views.size() && i < e.views.size(); ++i)
    j["views"].push_back({{"name", views[i].name},
                          {"told", e.views[i].told()},
                          {"explained", e.views[i].explained()},
                          {"disagreeing", e.views[i].count(Place::kDisagreeing)},
                          {"bare", e.views[i].count(Place::kBare)}});
  return j;
}

void add_views(const assess::Signals& s, std::span<const PreparedView> views,
               std::span<const assess::SilhouetteFit> fits, ordered_json& j) {
  for (std::size_t i = 0; i < views.size() && i < s.match.views.size(); ++i)
    j["views"].push_back({{"name", views[i].name},
                          {"residual", s.match.views[i].pixels},
                          {"matches", s.match.views[i].matches},
                          {"pixel_size", s.match.views[i].pixel_size}});
  for (std::size_t i = 0; i < views.size() && i < s.compared.views.size(); ++i) {
    j["views"][i]["told"] = s.compared.views[i].told();
    j["views"][i]["disagreeing"] = s.compared.views[i].count(assess::Place::kDisagreeing);
  }
  for (std::size_t i = 0; i < views.size() && i < fits.size(); ++i) {
    if (fits[i].foreground == 0) continue;  // its silhouette is not known
    j["views"][i]["missed"] = fits[i].missed;
    j["views"][i]["excess"] = fits[i].excess;
    j["views"][i]["beyond_box"] = fits[i].beyond_box;
  }
}

}  // namespace

std::string to_json(const assess::Verdict& verdict, const assess::Signals& s,
                    std::span<const PreparedView> views,
                    std::span<const assess::SilhouetteFit> fits) {
  ordered_json j = {{"level", assess::to_string(verdict.level)},
                    {"reasons", verdict.reasons},
                    {"notes", verdict.notes},
                    {"coverage", verdict.coverage},
                    {"signals",
                     {{"mean_confidence", s.mean_confidence},
                      {"unsure", s.unsure},
                      {"unseen", s.unseen},
                      {"few_views", s.few_views},
                      {"at_box", s.at_box},
                      {"hull_beyond_box", s.hull_beyond},
                      {"stems", s.stems},
                      {"stems_restored", s.stems_restored},
                      {"silhouettes_contradict", s.contradiction},
                      {"silhouettes_missed", s.missed},
                      {"silhouettes_missed_width", s.missed_width},
                      {"silhouettes_excess", s.excess},
                      {"silhouettes_beyond_box", s.beyond_box},
                      {"views_beyond_box", s.beyond_views},
                      {"pairs_seen", s.match.seen},
                      {"textured", s.match.textured},
                      {"matched", s.match.matched},
                      {"unconfirmed_patches", s.match.unconfirmed_patches},
                      {"offset", s.match.offset},
                      {"offset_beyond_voxel", s.match.beyond_near},
                      {"offset_beyond_half_percent", s.match.beyond_far},
                      {"residual", s.match.residual},
                      {"residual_pixel_size", s.match.pixel_size},
                      {"cameras_moved", s.cameras_moved},
                      {"cameras_moved_alike", s.cameras_moved_alike},
                      {"pixel_size", s.pixel_size},
                      {"half_percent", s.far},
                      {"voxel_size", s.voxel_size},
                      {"resolution", s.resolution},
                      {"views", s.views},
                      {"cameras_within", s.cameras_within},
                      {"silhouettes_bound", s.masks},
                      {"hull", s.hull}}}};
  if (s.common.tangents > 0)
    j["signals"]["outlines"] = {
        {"disagree", s.common.before},         {"moved", {s.common.shift.x, s.common.shift.y}},
        {"moved_sigma", s.common.shift_sigma}, {"focal_factor", s.common.focal_factor},
        {"focal_sigma", s.common.focal_sigma}, {"disagree_then", s.common.after},
        {"tangents", s.common.tangents}};
  add_views(s, views, fits, j);
  if (s.explained.looked_at() > 0) j["photographs"] = explained_json(s.explained, views);
  return j.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace photohull::pipeline

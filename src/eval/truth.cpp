#include "eval/truth.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/median.h"
#include "eval/nearest_sample.h"
#include "io/mesh/read_mesh.h"
#include "io/mesh/write_mesh.h"

namespace photohull::eval {
namespace {

namespace fs = std::filesystem;

struct Samples {
  std::vector<glm::dvec3> points;
  std::vector<std::uint8_t> views;
};

Samples read_samples(const fs::path& path) {
  VertexScalars scalars;
  const TriMesh cloud = read_ply(path, scalars);
  const auto views = scalars.find("views");
  if (cloud.positions.empty()) throw Error(concat(path.string(), " has no vertices; give samples"));
  if (views == scalars.end())
    throw Error(concat(path.string(),
                       " has no vertex property 'views', the number of cameras that ",
                       "see each sample; add it, or remove the file to let all surface count"));
  Samples samples;
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    const double count = views->second[i];
    if (!(count >= 0) || count != std::floor(count))
      throw Error(concat(path.string(), ": views of vertex ", i, " is ", count,
                         "; it must be a whole number from 0"));
    samples.points.push_back(cloud.world(i));
    samples.views.push_back(std::uint8_t(std::min(count, 255.0)));
  }
  return samples;
}

std::string points_note(const Truth& truth) {
  return concat("distances are to the nearest of ", truth.mesh().positions.size(),
                " points, which are ", float(truth.spacing()),
                " apart (median): less than that tells nothing");
}

template <typename Make>
Truth named(const fs::path& path, Make make) {
  try {
    return make();
  } catch (const Error& error) {
    throw Error(concat("the truth ", path.string(), " cannot be used: ", error.what()));
  }
}

/// Of up to a thousand of the points to the nearest other, the median.
double spacing_of(const std::vector<glm::dvec3>& points, const NearestSample& nearest) {
  constexpr std::size_t kLooked = 1000;
  const std::size_t step = std::max<std::size_t>(1, points.size() / kLooked);
  std::vector<double> distances;
  for (std::size_t i = 0; i < points.size(); i += step)
    distances.push_back(nearest.find_other(points[i]));
  return median(distances);
}

}  // namespace

Truth::Truth(TriMesh surface) : mesh_(std::move(surface)) {
  if (mesh_.triangles.empty()) {
    std::vector<glm::dvec3> points;
    for (std::size_t i = 0; i < mesh_.positions.size(); ++i) points.push_back(mesh_.world(i));
    if (points.size() < 2) throw Error("it has neither faces nor points; give a surface");
    points_ = std::make_unique<NearestSample>(points);
    spacing_ = spacing_of(points, *points_);
  } else {
    surface_.emplace(mesh_);
  }
  glm::vec3 low(INFINITY), high(-INFINITY);
  for (const glm::vec3& p : mesh_.positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  diagonal_ = glm::length(glm::dvec3(high) - glm::dvec3(low));
  if (!(diagonal_ > 0)) throw Error("its bounding box has no size; give a surface");
}

Truth::Truth(TriMesh surface, std::vector<glm::dvec3> samples, std::vector<std::uint8_t> views)
    : Truth(std::move(surface)) {
  if (samples.empty() || samples.size() != views.size())
    throw Error("it needs samples, each with its number of views");
  samples_ = std::move(samples);
  views_ = std::move(views);
}

Truth::~Truth() = default;
Truth::Truth(Truth&&) noexcept = default;
Truth& Truth::operator=(Truth&&) noexcept = default;

double Truth::distance(const glm::dvec3& p) const {
  return surface_ ? std::abs(surface_->at(p).distance) : points_->find(p).distance;
}

Truth read_truth(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored))
    throw Error(
        concat("there is no ", path.string(), "; give a scene folder with gt.ply, or a mesh"));
  if (!fs::is_directory(path, ignored)) {
    Truth truth = named(path, [&] { return Truth(read_mesh(path, Faces::kOptional)); });
    truth.name = path.string();
    truth.note = truth.is_points() ? concat("all points count: ", points_note(truth))
                                   : "all surface counts: a mesh does not say what cameras see";
    return truth;
  }
  const fs::path surface = path / "gt.ply", visible = path / "gt_visible.ply";
  if (!fs::is_regular_file(surface, ignored))
    throw Error(concat(path.string(),
                       " has no gt.ply, the exact surface; give a scene with truth, ",
                       "or a mesh"));
  const bool seen = fs::exists(visible, ignored);
  Truth truth = named(surface, [&] {
    TriMesh mesh = read_mesh(surface, Faces::kOptional);
    if (!seen) return Truth(std::move(mesh));
    Samples samples = read_samples(visible);
    return Truth(std::move(mesh), std::move(samples.points), std::move(samples.views));
  });
  truth.name = path.string();
  truth.note = seen ? "what cameras see counts, by gt_visible.ply"
                    : "all surface counts: the scene has no gt_visible.ply";
  if (truth.is_points()) truth.note += "; " + points_note(truth);
  return truth;
}

}  // namespace photohull::eval

#include "refine/contacts.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "masks/silhouette.h"
#include "projtex/gpu_views.h"

namespace photohull::refine {
namespace {

constexpr double kNoCrease = 0.3;     // cosine between an edge's normals up to which it is a curve
constexpr double kLeastNormal = 0.2;  // length of the mean of an edge's normals that is a direction
// Moving along the normal brings a contact to the outline, but for this share of its lack and so
// many voxels; else the outline runs another way than the surface, and it is none.
constexpr double kMissedShare = 0.3, kMissed = 0.05;
constexpr double kMostReach = SparseVolume::kBand - 0.01;  // voxels, whatever the pixels' size
constexpr double kLongest = 8;  // cells that a triangle's piece of the outline passes
constexpr double kMadeRim = 1;  // pixels: standard deviation of the outlines of masks that are made

/// The contacts of one view.
class Finder {
 public:
  Finder(const projtex::GridCamera& camera, const carving::Silhouette& silhouette,
         std::span<const glm::vec3> positions, std::span<const glm::vec3> normals, double reach)
      : camera_(camera),
        distance_(*silhouette.distance),
        rim_(silhouette.likelihood ? kMadeRim : 0),
        positions_(positions),
        normals_(normals),
        reach_(reach) {
    const glm::vec3 centre(camera.centre);
    facing_.resize(positions.size());
    double farthest = 1;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const glm::vec3 ray = centre - positions[i];
      facing_[i] = glm::dot(normals[i], ray);
      farthest = std::max(farthest, double(glm::dot(ray, ray)));
    }
    cell_ = std::max(camera.focal / std::sqrt(farthest), 1.0);
    width_ = int(camera.width / cell_) + 1;
    least_.assign(std::size_t(width_) * (std::size_t(camera.height / cell_) + 1),
                  std::numeric_limits<float>::max());
  }

  std::vector<Contact> run(const TriMesh& mesh) {
    std::vector<Place> found;
    for (const auto& t : mesh.triangles) {
      const int front = (facing_[t[0]] > 0) + (facing_[t[1]] > 0) + (facing_[t[2]] > 0);
      if (front == 0 || front == 3) continue;
      Place ends[2];
      int count = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t i = t[k], j = t[(k + 1) % 3];
        if ((facing_[i] > 0) == (facing_[j] > 0)) continue;
        // The same numbers from both of the edge's triangles, of which one hands it on.
        Place& end = ends[count++];
        end = place_of(std::min(i, j), std::max(i, j));
        if (end.known && i < j) found.push_back(end);
      }
      if (ends[0].known && ends[1].known) draw(ends[0], ends[1]);
    }
    std::vector<Contact> out;
    for (Place& place : found) {
      place.contact.least = std::min(least_[cell_of(place.outline)], place.contact.lack);
      out.push_back(place.contact);
    }
    return out;
  }

 private:
  struct Place {
    Contact contact;
    glm::dvec2 outline{0};  // the nearest point of the silhouette's outline, pixels
    bool known = false;
  };

  /// Where the surface along an edge turns from the camera, and what the silhouette says there.
  Place place_of(std::uint32_t i, std::uint32_t j) const {
    Place out;
    const double t = double(facing_[i]) / (double(facing_[i]) - double(facing_[j]));
    const glm::dvec3 a(positions_[i]), b(positions_[j]), na(normals_[i]), nb(normals_[j]);
    const glm::dvec3 mean = (1 - t) * na + t * nb;
    if (glm::length(mean) < kLeastNormal) return out;
    const glm::dvec3 normal = glm::normalize(mean);
    glm::dvec3 point = (1 - t) * a + t * b;
    if (glm::dot(na, nb) > kNoCrease)  // the surface bulges over its chord
      point += 0.5 * t * (1 - t) * glm::dot(nb - na, b - a) * normal;
    const glm::dvec3 p = camera_.projection * glm::dvec4(point, 1);
    if (p.z <= 1) return out;
    const glm::dvec2 pixel = glm::dvec2(p) / p.z;
    if (pixel.x < 0 || pixel.y < 0 || pixel.x > camera_.width - 1 || pixel.y > camera_.height - 1)
      return out;
    const double scale = p.z / camera_.focal;  // voxels a pixel
    const double lack = -interpolated(distance_, pixel) * scale;
    if (!(std::abs(lack) <= std::min(reach_ * std::max(scale, 1.0), kMostReach))) return out;
    const glm::dvec3 q = camera_.projection * glm::dvec4(point + lack * normal, 1);
    out.outline = glm::dvec2(q) / q.z;
    const double missed = std::abs(interpolated(distance_, out.outline)) * scale;
    if (missed > kMissedShare * std::abs(lack) + kMissed) return out;
    out.contact = {i, j, float(t), float(lack), float(lack), float(rim_ * scale)};
    out.known = true;
    return out;
  }

  /// Of the cells, about a voxel wide, that the outline is cut into.
  std::size_t cell_of(const glm::dvec2& pixel) const {
    const auto x = std::clamp(int(pixel.x / cell_), 0, width_ - 1);
    const auto y = std::max(int(pixel.y / cell_), 0);
    return std::min(std::size_t(y) * std::size_t(width_) + std::size_t(x), least_.size() - 1);
  }

  /// What the surface's outline between two contacts has for the cells that it passes.
  void draw(const Place& a, const Place& b) {
    const double length = glm::length(b.outline - a.outline) / cell_;
    if (length > kLongest) return;
    const int steps = int(2 * length) + 1;
    for (int k = 0; k <= steps; ++k) {
      const double t = double(k) / steps;
      float& least = least_[cell_of((1 - t) * a.outline + t * b.outline)];
      least = std::min(least, float((1 - t) * a.contact.lack + t * b.contact.lack));
    }
  }

  const projtex::GridCamera& camera_;
  const SilhouetteDistance& distance_;
  double rim_;
  std::span<const glm::vec3> positions_, normals_;
  double reach_, cell_ = 1;  // pixels
  int width_ = 0;            // cells
  std::vector<float> facing_, least_;
};

}  // namespace

std::vector<Contact> find_contacts(const GridSpec& grid, const TriMesh& mesh,
                                   std::span<const glm::vec3> positions,
                                   std::span<const glm::vec3> normals, const SilhouetteCones& cones,
                                   double reach) {
  std::vector<std::vector<Contact>> found(cones.cameras.size());
  tbb::parallel_for(std::size_t(0), found.size(), [&](std::size_t v) {
    if (!cones.silhouettes[v].distance) return;
    const projtex::GridCamera camera = projtex::to_grid(cones.cameras[v], grid);
    found[v] = Finder(camera, cones.silhouettes[v], positions, normals, reach).run(mesh);
  });
  std::vector<Contact> out;
  for (const auto& list : found) out.insert(out.end(), list.begin(), list.end());
  return out;
}

}  // namespace photohull::refine

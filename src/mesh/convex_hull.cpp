#include "mesh/convex_hull.h"

#include <libqhull_r/qhull_ra.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "core/error.h"

namespace photohull {
namespace {

/// Qhull's state, with the messages that it wrote.
class Hull {
 public:
  Hull() : messages_(::open_memstream(&text_, &length_)) {
    if (!messages_) throw Error("there is no memory for the messages of Qhull");
    qh_zero(&state_, messages_.get());
  }
  ~Hull() {
    int left_blocks, left_bytes;
    qh_freeqhull(&state_, !qh_ALL);
    qh_memfreeshort(&state_, &left_blocks, &left_bytes);
    messages_.reset();
    std::free(text_);
  }
  Hull(const Hull&) = delete;
  Hull& operator=(const Hull&) = delete;

  /// Qhull's exit code. `coordinates` must outlive this.
  int run(std::vector<double>& coordinates) {
    char command[] = "qhull Qt";  // faces of more than three corners in triangles
    return qh_new_qhull(&state_, 3, int(coordinates.size() / 3), coordinates.data(), False, command,
                        nullptr, messages_.get());
  }

  std::string messages() {
    std::fflush(messages_.get());
    return {text_, length_};
  }

  std::vector<std::array<std::uint32_t, 3>> faces() {
    qhT* const qh = &state_;  // what Qhull's macros take
    std::vector<std::array<std::uint32_t, 3>> out;
    facetT* facet;
    FORALLfacets {
      std::array<std::uint32_t, 3> corners{};
      for (int i = 0; i < 3; ++i)
        corners[std::size_t(i)] =
            std::uint32_t(qh_pointid(qh, SETelemt_(facet->vertices, i, vertexT)->point));
      if (facet->toporient != qh_ORIENTclock) std::swap(corners[1], corners[2]);
      out.push_back(corners);
    }
    return out;
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  char* text_ = nullptr;
  std::size_t length_ = 0;
  std::unique_ptr<std::FILE, Close> messages_;
  qhT state_{};
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> convex_hull(std::span<const glm::dvec3> points) {
  // Qhull asks for a width.
  if (std::ranges::all_of(points, [&](const glm::dvec3& p) { return p == points[0]; })) return {};
  if (points.size() < 4) return {};
  std::vector<double> coordinates;
  coordinates.reserve(3 * points.size());
  for (const glm::dvec3& p : points) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
  Hull hull;
  const int code = hull.run(coordinates);
  if (code == qh_ERRsingular) return {};
  if (code != 0) throw Error("no convex hull of the points can be made: " + hull.messages());
  return hull.faces();
}

}  // namespace photohull

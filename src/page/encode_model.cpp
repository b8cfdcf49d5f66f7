#include "page/encode_model.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/image.h"
#include "page/pack.h"

namespace photohull::page {
namespace {

using nlohmann::ordered_json;

constexpr double kPositionSteps = 65535, kPlaceSteps = 8191, kLayerSteps = 254;
constexpr std::uint32_t kNotKnown = 255;

/// Triangles and vertices in the order in which they are stored.
struct Order {
  std::vector<unsigned> corners;   ///< of all triangles, by new numbers
  std::vector<unsigned> vertices;  ///< old numbers by new ones
};

Order order(const TriMesh& mesh) {
  Order o;
  const std::size_t count = 3 * mesh.triangles.size();
  o.corners.resize(count);
  meshopt_optimizeVertexCache(o.corners.data(), mesh.triangles.front().data(), count,
                              mesh.positions.size());
  constexpr unsigned kNone = ~0u;
  std::vector<unsigned> rank(mesh.positions.size(), kNone);
  for (unsigned& corner : o.corners) {
    if (rank[corner] == kNone) {
      rank[corner] = unsigned(o.vertices.size());
      o.vertices.push_back(corner);
    }
    corner = rank[corner];
  }
  return o;
}

class Streams {
 public:
  /// `value(i, c)` is component c of element i, below 256^bytes.
  template <typename Value>
  void add(ordered_json entry, std::size_t count, int components, int bytes, const Value& value) {
    entry["components"] = components;
    entry["bytes"] = bytes;
    table_.push_back(std::move(entry));
    for (int c = 0; c < components; ++c)
      for (int b = 0; b < bytes; ++b)
        for (std::size_t i = 0; i < count; ++i)
          bytes_.push_back(std::uint8_t(value(i, c) >> (8 * b)));
  }

  /// The same of vertices: their differences.
  template <typename Value>
  void add_differences(ordered_json entry, std::size_t count, int components, int bytes,
                       const Value& value) {
    const int unused = 32 - 8 * bytes;
    std::vector<std::uint32_t> codes;
    codes.reserve(count * std::size_t(components));
    for (std::size_t i = 0; i < count; ++i)
      for (int c = 0; c < components; ++c) {
        const std::uint32_t before = i == 0 ? 0 : value(i - 1, c);
        // The difference in the stream's bits, with its sign in front, and then last.
        const auto d = std::int32_t((value(i, c) - before) << unused) >> unused;
        codes.push_back((std::uint32_t(d) << 1 ^ std::uint32_t(d >> 31)) & (~0u >> unused));
      }
    add(std::move(entry), count, components, bytes,
        [&](std::size_t i, int c) { return codes[i * std::size_t(components) + std::size_t(c)]; });
  }

  const ordered_json& table() const { return table_; }
  std::string packed() const { return page::packed(bytes_); }

 private:
  ordered_json table_ = ordered_json::array();
  std::vector<std::uint8_t> bytes_;
};

std::uint32_t layer_code(const Layer& layer, std::size_t vertex) {
  const double value = layer.values[vertex];
  if (std::isnan(value)) return kNotKnown;
  return std::uint32_t(std::lround(kLayerSteps * std::clamp(value / layer.most, 0.0, 1.0)));
}

void add_triangles(const Order& o, Streams& streams) {
  std::vector<std::uint32_t> codes;
  codes.reserve(o.corners.size());
  std::uint32_t next = 0;
  for (const unsigned corner : o.corners) {
    codes.push_back(next - corner);
    next += corner == next;
  }
  streams.add({{"name", "triangles"}}, codes.size(), 1, 4,
              [&](std::size_t i, int) { return codes[i]; });
}

}  // namespace

Model encode_model(const TriMesh& mesh, std::span<const Layer> layers,
                   std::span<const glm::vec2> places) {
  PHOTOHULL_CHECK(!mesh.triangles.empty());
  const Order o = order(mesh);
  glm::vec3 low = mesh.positions.front(), high = low;
  for (const glm::vec3& p : mesh.positions) low = glm::min(low, p), high = glm::max(high, p);
  const glm::dvec3 size = glm::dvec3(high) - glm::dvec3(low);
  const double longest = std::max({size.x, size.y, size.z});
  const double step = longest > 0 ? longest / kPositionSteps : 1;
  Streams streams;
  const std::size_t count = o.vertices.size();
  streams.add_differences({{"name", "position"}}, count, 3, 2, [&](std::size_t i, int c) {
    return std::uint32_t(
        std::lround((double(mesh.positions[o.vertices[i]][c]) - double(low[c])) / step));
  });
  PHOTOHULL_CHECK(places.empty() || places.size() == mesh.positions.size());
  if (!places.empty())
    streams.add_differences(
        {{"name", "place"}, {"step", 1 / kPlaceSteps}}, count, 2, 2, [&](std::size_t i, int c) {
          const double place = double(places[o.vertices[i]][c]);
          return std::uint32_t(std::lround(kPlaceSteps * std::clamp(place, 0.0, 1.0)));
        });
  if (places.empty() && !mesh.colours.empty())
    streams.add_differences({{"name", "colour"}}, count, 3, 1, [&](std::size_t i, int c) {
      const double linear = std::clamp(double(mesh.colours[o.vertices[i]][c]), 0.0, 1.0);
      return std::uint32_t(std::lround(255 * srgb_from_linear(linear)));
    });
  for (const Layer& layer : layers) {
    PHOTOHULL_CHECK_OP(layer.values.size(), ==, mesh.positions.size());
    streams.add_differences({{"name", layer.name}, {"step", layer.most / kLayerSteps}}, count, 1, 1,
                            [&](std::size_t i, int) { return layer_code(layer, o.vertices[i]); });
  }
  add_triangles(o, streams);
  const glm::dvec3 corner = mesh.origin + glm::dvec3(low);
  const ordered_json table = {{"vertices", count},
                              {"triangles", mesh.triangles.size()},
                              {"low", {corner.x, corner.y, corner.z}},
                              {"step", step},
                              {"streams", streams.table()}};
  return {table.dump(), streams.packed()};
}

}  // namespace photohull::page

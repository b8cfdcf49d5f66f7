// Writes binary PLY in large blocks.
#include "io/mesh/write_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/image.h"

namespace photohull {
namespace {

static_assert(std::endian::native == std::endian::little, "PLY records are copied as they are");

/// Linear light to the nearest 8-bit sRGB code, without a power per value: a table over 4096 steps
/// gives the code at the step's low end, and the next code's threshold says whether to add one
/// (the curve's slope is at most 12.92, less than a code per step).
class SrgbEncoder {
 public:
  SrgbEncoder() {
    for (int code = 0; code < 256; ++code)
      threshold_[code] = code == 0 ? -1.0f : float(linear_from_srgb((code - 0.5) / 255));
    threshold_[256] = std::numeric_limits<float>::infinity();
    for (int step = 0, code = 0; step <= kSteps; ++step) {
      while (threshold_[code + 1] <= float(step) / kSteps) ++code;
      code_[step] = std::uint8_t(code);
    }
  }
  std::uint8_t operator()(float linear) const {
    const float clamped = linear > 0 ? std::min(linear, 1.0f) : 0.0f;  // NaN becomes 0.
    const std::uint8_t code = code_[int(clamped * kSteps)];
    return clamped >= threshold_[code + 1] ? code + 1 : code;
  }

 private:
  static constexpr int kSteps = 4096;
  std::array<float, 257> threshold_;
  std::array<std::uint8_t, kSteps + 1> code_;
};

/// Collects small records into blocks for the file.
class BlockWriter {
 public:
  explicit BlockWriter(AtomicFile& file) : file_(file) { block_.resize(kBlock); }
  template <typename T>
  void put(const T& value) {
    std::memcpy(block_.data() + used_, &value, sizeof value);
    used_ += sizeof value;
  }
  /// Makes room for a record of at most kRecord bytes.
  void begin_record() {
    if (used_ + kRecord > kBlock) flush();
  }
  void flush() {
    file_.write(block_.data(), used_);
    used_ = 0;
  }

 private:
  static constexpr std::size_t kBlock = std::size_t(1) << 20;
  static constexpr std::size_t kRecord = 80;
  AtomicFile& file_;
  std::vector<char> block_;
  std::size_t used_ = 0;
};

/// Mean edge length over up to a few thousand triangles spread over the mesh; 0 without triangles.
double mean_edge(const TriMesh& mesh) {
  const std::size_t stride = mesh.triangles.size() / 4096 + 1;
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += stride, ++count) {
    const auto& [a, b, c] = mesh.triangles[i];
    sum += glm::length(mesh.positions[a] - mesh.positions[b]) +
           glm::length(mesh.positions[b] - mesh.positions[c]) +
           glm::length(mesh.positions[c] - mesh.positions[a]);
  }
  return count ? sum / (3.0 * double(count)) : 0.0;
}

/// Would world coordinates in float be off by more than a thousandth of an edge?
bool needs_double(const TriMesh& mesh) {
  glm::vec3 reach(0);
  for (const glm::vec3& p : mesh.positions) reach = glm::max(reach, glm::abs(p));
  const glm::dvec3 world = glm::abs(mesh.origin) + glm::dvec3(reach);
  const double rounding = std::ldexp(std::max({world.x, world.y, world.z}), -24);
  return rounding > 1e-3 * mean_edge(mesh) && !mesh.triangles.empty();
}

void check_attributes(const TriMesh& mesh, const VertexScalars& scalars) {
  const std::size_t count = mesh.positions.size();
  PHOTOHULL_CHECK(mesh.normals.empty() || mesh.normals.size() == count);
  PHOTOHULL_CHECK(mesh.colours.empty() || mesh.colours.size() == count);
  PHOTOHULL_CHECK(mesh.confidence.empty() || mesh.confidence.size() == count);
  PHOTOHULL_CHECK(scalars.size() <= 4);
  for (const auto& scalar : scalars) PHOTOHULL_CHECK(scalar.second.size() == count);
}

std::string header(const PlyLayout& layout, const VertexScalars& scalars) {
  const char* real = layout.doubles ? "double" : "float";
  std::string text = concat("ply\nformat binary_little_endian 1.0\ncomment created by photohull ",
                            PHOTOHULL_VERSION, "\nelement vertex ", layout.vertices, "\n");
  for (const char* axis : {"x", "y", "z"}) text += concat("property ", real, " ", axis, "\n");
  if (layout.normals) text += "property float nx\nproperty float ny\nproperty float nz\n";
  if (layout.colours) text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  if (layout.confidence) text += "property float confidence\n";
  for (const auto& scalar : scalars) text += concat("property float ", scalar.first, "\n");
  return text + concat("element face ", layout.triangles,
                       "\nproperty list uchar int vertex_indices\nend_header\n");
}

void put_vertices(const TriMesh& mesh, const VertexScalars& scalars, const PlyLayout& layout,
                  BlockWriter& out) {
  static const SrgbEncoder encode;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    out.begin_record();
    if (layout.doubles)
      out.put(mesh.world(i));
    else
      out.put(glm::vec3(mesh.world(i)));
    if (layout.normals) out.put(mesh.normals[i]);
    if (layout.colours) {
      const glm::vec3& linear = mesh.colours[i];
      out.put(std::array{encode(linear.r), encode(linear.g), encode(linear.b)});
    }
    if (layout.confidence) out.put(mesh.confidence[i]);
    for (const auto& scalar : scalars) out.put(float(scalar.second[i]));
  }
}

void put_faces(const std::vector<std::array<std::uint32_t, 3>>& triangles, BlockWriter& out) {
  for (const auto& triangle : triangles) {
    out.begin_record();
    out.put(std::uint8_t(3));
    out.put(triangle);
  }
}

}  // namespace

PlyLayout ply_layout(const TriMesh& mesh) {
  return {!mesh.normals.empty(), !mesh.colours.empty(), !mesh.confidence.empty(),
          needs_double(mesh),    mesh.positions.size(), mesh.triangles.size()};
}

PlyFile::PlyFile(AtomicFile& file, const PlyLayout& layout) : file_(file), layout_(layout) {
  const std::string text = header(layout, {});
  file.write(text.data(), text.size());
}

void PlyFile::add_vertices(const TriMesh& mesh) {
  check_attributes(mesh, {});
  PHOTOHULL_CHECK(!layout_.normals || !mesh.normals.empty());
  PHOTOHULL_CHECK(!layout_.colours || !mesh.colours.empty());
  PHOTOHULL_CHECK(!layout_.confidence || !mesh.confidence.empty());
  BlockWriter out(file_);
  put_vertices(mesh, {}, layout_, out);
  out.flush();
}

void PlyFile::add_triangles(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  BlockWriter out(file_);
  put_faces(triangles, out);
  out.flush();
}

void write_ply(AtomicFile& file, const TriMesh& mesh, const VertexScalars& scalars) {
  check_attributes(mesh, scalars);
  const PlyLayout layout = ply_layout(mesh);
  const std::string text = header(layout, scalars);
  file.write(text.data(), text.size());
  BlockWriter out(file);
  put_vertices(mesh, scalars, layout, out);
  put_faces(mesh.triangles, out);
  out.flush();
}

void write_ply(AtomicFile& file, const TriMesh& mesh) { write_ply(file, mesh, VertexScalars()); }

void write_ply(const std::filesystem::path& path, const TriMesh& mesh) {
  write_ply(path, mesh, VertexScalars());
}

void write_ply(const std::filesystem::path& path, const TriMesh& mesh,
               const VertexScalars& scalars) {
  AtomicFile file(path);
  write_ply(file, mesh, scalars);
  file.commit();
}

}  // namespace photohull

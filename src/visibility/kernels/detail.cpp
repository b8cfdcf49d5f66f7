// Based on: P. Lecocq, J.-E. Marvie, G. Sourimant, P. Gautron, "Sub-pixel shadow mapping", I3D
// 2014; H. Li, H. Yang, C. Han, J. Zhao, "Coverage detecting algorithm based on sub-pixel geometric
// primitives", Journal of System Simulation 29(11), 2017.
#include "visibility/kernels/detail.h"

#include <bit>
#include <limits>

#include "core/error.h"

namespace photohull::visibility {
namespace {

/// Compiles in the second storage block of the lists.
constexpr const char* kTwoBlocks = "#define LISTS_IN_TWO_BLOCKS\n";

}  // namespace

class DetailRenderer {
 public:
  DetailRenderer(gpu::Context& context, const Geometry& geometry, VisibilityMap& map)
      : context_(context), geometry_(geometry), map_(map) {
    const MapLayout& layout = map.layout_;
    parts_ = layout.parts.size();
    texels_ = parts_ * std::size_t(layout.size.x) * std::size_t(layout.size.y);
    const bool anything = layout.far > layout.near;
    triangle_count_ = anything ? geometry.triangles() : 0;
  }

  void run() {
    check_size(geometry_.triangles() * parts_ * sizeof(shaders::MapTriangle));
    map_.triangles_ = gpu::Buffer(std::max<std::size_t>(1, geometry_.triangles() * parts_) *
                                  sizeof(shaders::MapTriangle));
    large_ = gpu::Buffer((geometry_.triangles() + 1) * 4);
    check_size(texels_ * 4);
    depths_ = gpu::Buffer(texels_ * 4);
    depths_.fill(std::bit_cast<unsigned>(std::numeric_limits<float>::infinity()));
    if (map_.technique_.detail == Detail::kLists)
      list_all();
    else
      keep_nearest();
  }

 private:
  void check_size(std::size_t bytes) const {
    if (bytes > std::size_t(context_.limits().ssbo_bytes))
      throw Error(concat("a sub-pixel map needs ", bytes >> 20,
                         " MiB in one block, more than this device has; lower the resolution"));
  }

  void bind(const gpu::Buffer& words) const {
    map_.info_.bind_uniform(shaders::kMapInfoBinding);
    large_.bind_storage(shaders::kLargeTrianglesBinding);
    depths_.bind_storage(shaders::kCoverDepthsBinding);
    geometry_.positions().bind_storage(shaders::kMeshPositionsBinding);
    geometry_.indices().bind_storage(shaders::kMeshIndicesBinding);
    map_.triangles_.bind_storage(shaders::kMapTrianglesBinding);
    words.bind_storage(shaders::kCoverWordsBinding);
    (map_.list_.id() ? map_.list_ : large_).bind_storage(shaders::kMapListBinding);
    if (map_.list_rest_.id()) map_.list_rest_.bind_storage(shaders::kMapListRestBinding);
  }

  /// Runs a pass of visibility_cover_texels over all triangles of a partition.
  void cover(const char* mode, int part, std::size_t large_triangles) {
    const auto launch = [&](const std::string& defines, std::size_t groups) {
      const auto program =
          gpu::Program::compute(context_, "visibility_cover_texels.comp.glsl", defines);
      program->set("part", part);
      program->dispatch(context_, "visibility_cover_texels", groups);
    };
    std::string defines = concat("#define COVER_", mode, "\n");
    if (map_.list_rest_.id()) defines += kTwoBlocks;
    launch(defines, gpu::group_count(triangle_count_, 64));
    launch(defines + "#define COVER_LARGE\n", large_triangles);
  }

  /// Sets the triangles of a partition up; returns how many are large.
  std::size_t set_up(int part) {
    const std::uint32_t none = 0;
    large_.write(0, 4, &none);
    const auto program = gpu::Program::compute(context_, "visibility_setup_triangles.comp.glsl");
    program->set("part", part);
    program->dispatch(context_, "visibility_setup_triangles",
                      gpu::group_count(triangle_count_, 64));
    return large_.download<std::uint32_t>(1)[0];
  }

  void keep_nearest() {
    map_.list_ends_ = gpu::Buffer(texels_ * 4);
    map_.list_ends_.fill(shaders::kNoTriangle);
    bind(map_.list_ends_);
    for (int part = 0; part < int(parts_); ++part) {
      const std::size_t large = set_up(part);
      cover("NEAREST", part, large);
      cover("ID", part, large);
    }
  }

  void list_all() {
    std::vector<std::size_t> large(parts_);
    gpu::Buffer counts(texels_ * 4);
    counts.fill(0);
    bind(counts);
    for (int part = 0; part < int(parts_); ++part) {
      large[std::size_t(part)] = set_up(part);
      large_lists_.push_back(large_.download<std::uint32_t>(large[std::size_t(part)], 1));
      cover("DEPTH", part, large[std::size_t(part)]);
      cover("COUNT", part, large[std::size_t(part)]);
    }
    std::vector<std::uint32_t> ends = counts.download<std::uint32_t>(texels_);
    std::size_t total = 0;
    for (std::uint32_t& count : ends) {
      const std::size_t start = total;
      total += count;
      count = std::uint32_t(start);
    }
    check_size((total - std::min<std::size_t>(total, map_.technique_.list_block)) * 4);
    counts.write(0, texels_ * 4, ends.data());
    ends.push_back(std::uint32_t(total));
    map_.list_ends_ = gpu::Buffer::of(ends);
    make_lists(total);
    bind(counts);
    for (int part = 0; part < int(parts_); ++part) {
      const auto& list = large_lists_[std::size_t(part)];
      if (!list.empty()) large_.write(4, list.size() * 4, list.data());
      cover("FILL", part, large[std::size_t(part)]);
    }
  }

  /// Room for all lists together, in two storage blocks where one is too small.
  void make_lists(std::size_t total) {
    const std::size_t first = std::min<std::size_t>(total, map_.technique_.list_block);
    map_.linked_ = total;
    map_.list_ = gpu::Buffer(std::max<std::size_t>(first, 1) * 4);
    if (total == first) return;
    map_.list_rest_ = gpu::Buffer((total - first) * 4);
    map_.test_ = gpu::Program::compute(context_, "visibility_test_receivers.comp.glsl",
                                       technique_defines(map_.technique_) + kTwoBlocks);
  }

  gpu::Context& context_;
  const Geometry& geometry_;
  VisibilityMap& map_;
  std::size_t parts_ = 0, texels_ = 0, triangle_count_ = 0;
  gpu::Buffer large_, depths_;
  std::vector<std::vector<std::uint32_t>> large_lists_;
};

void draw_detail(gpu::Context& context, const Geometry& geometry, VisibilityMap& map) {
  DetailRenderer(context, geometry, map).run();
}

}  // namespace photohull::visibility

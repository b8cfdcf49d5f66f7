// The kernels of the plane sweep on their own, bound as carve_photo binds them.
#pragma once

#include <vector>

#include "carving/bit_volume.h"
#include "carving/decisions.h"
#include "carving/photo_reference.h"
#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/program.h"
#include "shared/sweep.h"
#include "visibility/kernels/depth_maps.h"

namespace photohull::carving::test_kernels {

/// What the selection step of a layer wrote.
struct SelectedLayer {
  std::vector<glm::ivec2> judged;  ///< columns, in the order that scores are given in
  std::vector<glm::ivec3> occluders;
};

class SweepKernels {
 public:
  /// The sweep goes along `frame` through `bits`; every brick of a layer is an item, and each item
  /// has all `cameras` (at most kMaxLayerViews) as views.
  /// `score_defines`: which statistic (statistic_defines), and `shifts` search offsets.
  SweepKernels(gpu::Context& context, const BitVolume& bits, const reference::SweepFrame& frame,
               const std::vector<projtex::GridCamera>& cameras,
               const std::string& score_defines = {}, int shifts = 1);

  /// Parameters that the tests set; layer, items and chunks are filled in by the steps.
  shaders::SweepParameters parameters{};

  SelectedLayer select(int layer);
  /// Marks voxels (a list with a header of 16 bytes) as passed, for exact rays.
  void mark(const gpu::Buffer& voxels, std::size_t count);
  /// Scores of the selected columns: score, views used, texture variance, views that see.
  /// `samples`: (selected brick, view, apron) as the projection writes them.
  std::vector<glm::vec4> score(const std::vector<glm::vec4>& samples);
  void update(const std::vector<glm::vec4>& scores);

  /// In `samples` of score: where the patch of a judged column begins in a view.
  std::size_t patch_base(std::size_t judged, int view, int shift = 0) const;
  std::size_t sample_count() const {
    return entries_.size() * shaders::kMaxLayerViews * std::size_t(shifts_) * shaders::kApronArea;
  }
  visibility::DepthMaps& depth_maps() { return maps_; }
  const gpu::Buffer& views() const { return views_; }
  /// Is a path open, for every column of the grid?
  std::vector<std::uint8_t> on_path() const;
  std::vector<Decision> decisions() const;
  std::vector<glm::ivec3> occluders() const;
  std::uint32_t judged_count() const;

 private:
  void set_parameters();

  gpu::Context& context_;
  reference::SweepFrame frame_;
  glm::ivec3 bricks_;
  int view_count_, shifts_;
  std::shared_ptr<const gpu::Program> select_, score_, update_, mark_;
  visibility::DepthMaps maps_;
  gpu::Buffer views_, table_, occupancy_, columns_, active_, passed_, uniforms_;
  gpu::Buffer items_, selected_, occluders_, packed_, scores_, decisions_;
  std::vector<glm::uvec4> entries_;  ///< selected bricks of the layer
  std::vector<shaders::SelectedColumn> judged_;
  bool by_rays_;
};

}  // namespace photohull::carving::test_kernels

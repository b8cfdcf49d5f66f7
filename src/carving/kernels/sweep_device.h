// The kernels of a plane sweep, with what they work on on the device (carving_select_columns,
// carving_score_columns, carving_update_columns and carving_mark_passed.comp.glsl).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "carving/bit_volume.h"
#include "carving/kernels/layer_sampling.h"
#include "carving/kernels/sweep_bands.h"
#include "carving/layer_item.h"
#include "carving/photo.h"
#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/program.h"
#include "projtex/device_views.h"
#include "projtex/gpu_views.h"
#include "shared/sweep.h"
#include "visibility/kernels/depth_maps.h"

namespace photohull::carving {

class SweepDevice {
 public:
  /// For sweeps through `bits`; `cameras` are in its grid's frame and in the images' order. No
  /// brick is active. Throws Error when the device cannot hold it.
  SweepDevice(gpu::Context& context, const BitVolume& bits,
              std::span<const projtex::GridCamera> cameras, LayerSampling sampling,
              const PhotoOptions& options);

  /// The voxels that stand from now on, on the same bricks.
  void set_standing(const BitVolume& bits);
  /// Bricks that a sweep has to look at, 1 or 0 for each brick of the grid.
  std::vector<std::uint32_t> active() const;
  void set_active(std::span<const std::uint32_t> active);

  /// Nothing is passed, and so nothing hidden.
  void begin(const SweepDirection& direction);
  /// Judges what is bare on a layer or on an open path. Layer 0 is where the sweep begins. Returns
  /// how many samples of the images were taken.
  std::int64_t judge_layer(int layer, BandWork& work);
  /// What stands on the layer that was judged hides what the sweep comes to.
  void hide_behind(int layer, const BandWork& work);

 private:
  /// A run of selected bricks, and of their columns.
  struct Chunk {
    std::size_t first_brick = 0, first_column = 0, columns = 0;
  };
  /// What each step works on: they have bindings in common.
  void set_parameters(int layer, const BandWork& work, const Chunk& chunk);
  void bind_selection(const BandWork& work) const;
  void bind_sampling(const BandWork& work) const;
  void bind_scoring(const BandWork& work) const;
  void bind_update(const BandWork& work) const;
  std::size_t pack_columns(BandWork& work);

  bool is_by_rays() const { return options_.visibility == visibility::SweepTest::kRays; }

  gpu::Context& context_;
  LayerSampling sampling_;
  PhotoOptions options_;
  glm::ivec3 bricks_;               ///< of the grid
  std::vector<glm::dvec2> search_;  ///< offsets at which views look for a voxel
  std::size_t chunk_;               ///< bricks whose samples are held at once
  visibility::DepthMaps maps_;
  projtex::DeviceViews views_;
  std::shared_ptr<const gpu::Program> select_, score_, update_, mark_;
  gpu::Buffer table_, occupancy_, active_, samples_, packed_, uniforms_;
  gpu::Buffer passed_;  ///< bits of the voxels that hide what the sweep comes to, for rays
  std::vector<shaders::SelectedColumn> columns_of_layer_;
  SweepDirection direction_{};
};

}  // namespace photohull::carving

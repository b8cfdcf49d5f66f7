// Shadows from visibility maps that lights look through, in place of exact rays. Internal to synth.
#pragma once

#include "synth/shading.h"
#include "visibility/kernels/visibility_map.h"

namespace photohull::synth {

/// Belongs to the thread of its context.
class LightMaps {
 public:
  /// `spec.shadow_test` names a technique. Throws Error when the device cannot hold the maps.
  LightMaps(gpu::Context& context, const LightSpec& spec, const Surface& surface,
            const std::vector<Light>& lights);
  /// The camera whose rays are asked next; maps that are warped are drawn for it.
  void look_from(const Camera& eye);
  /// Misses and what turns away from a light have none of it.
  LightShares shares(std::span<const Ray> rays, std::span<const Hit> hits) const;

 private:
  struct Map {
    Camera viewpoint;
    std::optional<visibility::VisibilityMap> drawn;
  };
  visibility::Sample sample_at(const Ray& ray, const Hit& hit) const;
  std::vector<float> share_of(std::size_t light,
                              const std::vector<visibility::Sample>& samples) const;

  gpu::Context& context_;
  const Surface& surface_;
  const std::vector<Light>& lights_;
  visibility::Geometry geometry_;
  visibility::Technique technique_;
  std::vector<std::vector<Map>> maps_;  ///< of each light
  Camera eye_;
};

}  // namespace photohull::synth

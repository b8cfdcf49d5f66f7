// A photograph predicted from a mesh and from other photographs.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "core/describe.h"
#include "core/mesh.h"
#include "core/prepared_view.h"
#include "raycast/ray_scene.h"

namespace photohull::eval {

struct PredictOptions {
  int blend = 4;  ///< photographs blended at a point
  /// Angle at the point between the ray predicted and one that lends colour, degrees; from
  /// `least_angle` to `most_angle`, 0 <= least < most <= 90. Colours from nearby views hide errors
  /// of depth, those from far away show them.
  double least_angle = 0;
  double most_angle = 60;

  /// Throws UsageError naming the option.
  void validate() const;
};

void describe(Described& to, PredictOptions& options);

enum class PixelState : unsigned char {
  kMiss,   ///< the mesh is not there
  kUnlit,  ///< it is, but no lending view sees that point at an allowed angle
  kLit     ///< predicted
};

/// Row-major from the top-left, as large as the photograph.
struct Prediction {
  int width = 0;
  int height = 0;
  std::vector<PixelState> state;
  std::vector<glm::vec3> colour;  ///< linear light; 0 where not kLit
};

/// Casts a ray through the centre of every pixel of the camera and blends, at the point it meets,
/// the colours of the `blend` lending views that are nearest in angle, with the weights of
/// [Buehler01]: (1 - a / a_next) / a for the angle a, where a_next is that of the next view that
/// sees the point, or most_angle, so that weights go to zero before a view drops out.
///
/// A view sees the point when it is on the same side of the face, the point is on its image where
/// alpha is 1, and nothing lies between them but what is within one of its pixels' footprints of
/// the point: facets of the size of voxels shadow themselves otherwise. Colours are interpolated by
/// Catmull-Rom's cubic in linear light, without prefilter: a lending view several times closer than
/// the predicted one aliases. Works in parallel over rows; the result is the same whatever the
/// number of threads. `row_done` is called, from any thread, after each row and may throw.
Prediction predict_photo(const TriMesh& mesh, const RayScene& rays, const Camera& camera,
                         std::span<const PreparedView> views, std::span<const std::size_t> lenders,
                         const PredictOptions& options, const std::function<void()>& row_done);

}  // namespace photohull::eval

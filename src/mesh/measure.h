// Lengths, areas and volumes of meshes.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/box.h"
#include "core/describe.h"
#include "core/mesh.h"

namespace photohull {

/// The axis of height and of cross-sections.
enum class MeasureAxis { kUp, kX, kY, kZ };

const char* to_string(MeasureAxis axis);

struct MeasureOptions {
  MeasureAxis axis = MeasureAxis::kUp;
  int sections = 10;

  /// Throws UsageError naming the option.
  void validate() const;
};

void describe(Described& to, MeasureOptions& options);

/// A quantity and its standard uncertainty, both in the same unit.
struct Measured {
  double value = 0;
  double uncertainty = 0;
};

/// A box whose axes are its own.
struct OrientedBox {
  glm::dvec3 center{0.0};  ///< world
  glm::dmat3 axes{1.0};    ///< unit, right-handed, the longest first
  glm::dvec3 size{0.0};    ///< world units, along these
};

struct CrossSection {
  double position = 0;  ///< along the axis: dot(axis, x) of its points, world units
  Measured area;
};

/// All in world units, their squares and cubes.
struct Measurements {
  glm::dvec3 axis{0.0, 0.0, 1.0};  ///< unit
  bool closed = true;
  std::optional<Measured> volume;  ///< nothing: the mesh is open, and bounds none
  Measured area;
  Measured height;  ///< extent along the axis
  Box box;          ///< along the world's axes
  Measured box_volume;
  OrientedBox oriented;
  Measured hull_volume;  ///< of the convex hull
  std::vector<CrossSection>
      sections;       ///< in the middle of slabs of the same height; empty where open
  double unseen = 0;  ///< share of the area that no camera sees, whose uncertainty is a guess
};

/// Measures a mesh; `up` is the axis of MeasureAxis::kUp and `voxel_size` what its confidence is
/// about. Confidence c is the chance that a vertex lies within a voxel of the truth: of errors with
/// a normal distribution, the standard deviation is s = voxel_size / (sqrt(2) erfinv(c)), here
/// three voxels at most. A quantity's uncertainty is half of what it changes by when all vertices
/// move along their normals by s outward instead of inward: as if all errors had the same
/// direction, which is the worst that they can do together. Without confidence it is 0. Throws
/// Error for a mesh without triangles.
Measurements measure(const TriMesh& mesh, const glm::dvec3& up, double voxel_size,
                     const MeasureOptions& options = {});

}  // namespace photohull

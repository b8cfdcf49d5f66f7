// Meshes of functions of space. Internal to synth.
#pragma once

#include <functional>
#include <glm/glm.hpp>

#include "core/grid.h"
#include "core/mesh.h"

namespace photohull::synth {

/// Negative inside; about the distance to the surface, in world units, near it.
using Field = std::function<double(const glm::dvec3&)>;

/// The same on the lattice's own points.
using LatticeField = std::function<double(const glm::ivec3& voxel)>;

/// The zero set of a function as a closed mesh: `sampled` is meshed through a volume, and every
/// vertex then moved onto the zero of `exact`, which is the same function.
TriMesh mesh_of_field(const LatticeField& sampled, const Field& exact, const GridSpec& grid);

/// The same for a function that nowhere changes faster than distances do: it is not asked where it
/// is known to be far from zero.
TriMesh mesh_of_distance(const Field& field, const GridSpec& grid);

}  // namespace photohull::synth

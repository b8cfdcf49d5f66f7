// Private to module mesh: where the creases of a mesh run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/crease.h"

namespace photohull {

/// The vertices that creases may have rounded, and the crease that holds at each. Their places in
/// the list are their ranks.
struct CreaseField {
  static constexpr std::uint32_t kNone = ~std::uint32_t(0);

  std::vector<std::uint32_t> list;   ///< the rounded vertices
  std::vector<std::uint32_t> rank;   ///< of every vertex of the mesh; kNone: it is not in the list
  std::vector<Crease> creases;       ///< where they were looked for
  std::vector<std::uint32_t> index;  ///< in `creases`, of every rank
  std::vector<std::uint32_t> host;   ///< rank whose crease holds at a rank; kNone: there is none

  /// What was found at a rank. Nothing is known where none was looked for.
  const Crease& crease_at(std::size_t place) const;
  std::uint32_t host_of(std::uint32_t vertex) const {
    return rank[vertex] == kNone ? kNone : host[rank[vertex]];
  }
  /// Does no crease hold anywhere?
  bool empty() const;
};

/// Marks what bends, with a margin, as rounded in `mesh`, looks for creases there, and keeps those
/// on which their surroundings agree and that are long enough. A unit of length of `mesh` is
/// `voxels` voxels. The result does not depend on the number of threads.
CreaseField find_crease_field(CreaseMesh& mesh, const SharpenOptions& options, double voxels);

}  // namespace photohull

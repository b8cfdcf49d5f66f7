// Of jobs that are too large in one piece.
#pragma once

#include <string>

#include "core/error.h"

namespace photohull {

/// A job's voxels are too many for its memory, or for one lattice. Parts of it may fit.
class TooManyVoxels : public Error {
 public:
  /// `problem` and `mend`: the two halves of its message. `voxel_size`: world units. `room`: about
  /// which share of the job's surface fits at once, less than 1, and at most 0 where not even a
  /// little of it would; 1: that is not known.
  TooManyVoxels(const std::string& problem, const std::string& mend, double voxel_size, double room)
      : Error(problem + "; " + mend), problem_(problem), voxel_size_(voxel_size), room_(room) {}
  const std::string& problem() const { return problem_; }
  double voxel_size() const { return voxel_size_; }
  double room() const { return room_; }

 private:
  std::string problem_;
  double voxel_size_, room_;
};

}  // namespace photohull

// Double-precision references of the plane-sweep kernels, written from the definitions.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "carving/bit_volume.h"
#include "carving/decisions.h"
#include "shared/sweep.h"

namespace photohull::carving::reference {

/// Square-root encoded colours around a voxel on the reference plane, in one view.
inline constexpr int kPatchTaps = (2 * shaders::kPatchRadius + 1) * (2 * shaders::kPatchRadius + 1);
using Patch = std::array<glm::dvec3, kPatchTaps>;
/// The same of any number of taps.
using PatchColours = std::span<const glm::dvec3>;

struct Consistency {
  double score = -1;   ///< mean correlation of all pairs of the views used; -1 below two views
  int used = 0;        ///< views left once outliers are dropped
  double texture = 0;  ///< variance per channel, mean over the views
  int seen = 0;        ///< views given
  double outlier_margin = 1;  ///< least gap between a view's agreement and the one that drops views
};

/// Photo-consistency of a voxel from the views that see it (consistency_zncc.glsl):
/// zero-mean normalised cross-correlation of patches over the three channels together, the variance
/// of each patch raised by the image noise's. Views that agree with the others less than half as
/// well as the best one does are dropped, once.
Consistency photo_consistency(std::span<const Patch> patches, double noise_variance);
/// On the taps that all the views show; as many in each.
Consistency photo_consistency(std::span<const PatchColours> patches, double noise_variance);

/// A patch with its samples' alpha: below 0 off the image, 0 background.
using ShownPatch = std::array<glm::dvec4, kPatchTaps>;

struct SearchedShifts {
  std::vector<int> shifts;  ///< of each view; -1 where no shift shows the patch
  double margin = 2;        ///< least gap between the best two correlations of a choice
};

/// r-consistency [Kutulakos00] (search_patches.glsl): `views` holds every view's patches within the
/// search disc. Each takes its first whole patch, then in turn, kSearchRounds times, the one that
/// correlates best with the mean of the others' normalised patches. With `coverage`, taps that show
/// background count as the patch's mean.
SearchedShifts choose_shifts(const std::vector<std::vector<ShownPatch>>& views,
                             double noise_variance, bool coverage);

/// A sweep along an axis of a grid; layer 0 is where it begins.
struct SweepFrame {
  int axis = 2, sign = 1;
  glm::ivec3 voxels{0};  ///< of the grid

  int u() const { return (axis + 1) % 3; }
  int v() const { return (axis + 2) % 3; }
  glm::ivec3 voxel(const glm::ivec2& column, int layer) const;
};

/// What a layer's first step finds in the columns of a brick (carving_select_columns.comp.glsl).
struct SelectedColumns {
  std::vector<glm::ivec2> judged;     ///< bare there, or on an open path
  std::vector<glm::ivec3> occluders;  ///< other voxels that stand next to empty space
};

/// `origin` is the brick's first column; `on_path` tells of each column of the grid (u fastest)
/// whether a path is open there.
SelectedColumns select(const BitVolume& bits, const SweepFrame& frame, int layer,
                       const glm::ivec2& origin, std::span<const std::uint8_t> on_path);

struct JudgeRules {
  double keep_score = 0, better_by = 0;
  int min_views = 0;
  double min_texture = 0;  ///< variance
  int max_path = 0;        ///< layers
};

/// Decides about one column when everything about it is known (carving_update_columns.comp.glsl
/// meets it layer by layer). Where the last path is still open at the end of the grid, nothing is
/// decided.
class ColumnJudge {
 public:
  /// `standing` and `scores` have an entry a layer.
  ColumnJudge(const JudgeRules& rules, std::span<const std::uint8_t> standing,
              std::span<const Consistency> scores)
      : rules_(rules), standing_(standing), scores_(scores) {}

  /// Outcomes of the bare voxels, front to back.
  std::vector<Decision> decisions(const glm::ivec2& column) const;

 private:
  int layers() const { return int(standing_.size()); }
  bool can_tell(int layer) const;
  /// What a layer counts for in the search for a better explanation.
  double value(int layer) const;
  /// First layer behind `bare` that its path cannot enter.
  int path_end(int bare) const;
  /// Layer of the explanation that the path from `bare` settles on; -1 when the grid ends first.
  int explanation(int bare) const;

  JudgeRules rules_;
  std::span<const std::uint8_t> standing_;
  std::span<const Consistency> scores_;
};

}  // namespace photohull::carving::reference

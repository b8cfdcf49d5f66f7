// Where the next, finer level has nothing to match: "model no more than a scene needs"
// [Montenegro03, chapter 5].
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/camera.h"
#include "core/describe.h"
#include "core/grid.h"
#include "refine/displacement.h"
#include "refine/match.h"
#include "refine/view_choice.h"

namespace photohull::refine {

struct SettleOptions {
  double least_pixels = 0.5, least_texture = 0.2, flat = 0.02;
};

inline void describe(Described& to, SettleOptions& o) {
  to.number("least_pixels", &o.least_pixels, from_to(0, 1000), "pixels",
            "edge of a finer voxel in the surfels' reference views below which it is not matched");
  to.number("least_texture", &o.least_texture, from_to(0, 1), "",
            "mean weight of texture below which finer voxels are not matched");
  to.number("flat", &o.flat, from_to(0, 1000), "1 / voxel",
            "curvature below which a plane says what finer voxels would");
}

/// What a brick's surface has left to tell.
enum class Settled : std::uint8_t {
  kSplit,   ///< finer voxels will be matched
  kPixels,  ///< finer voxels would be below the images' sampling
  kPlain,   ///< no texture beyond noise
  kFlat,    ///< plane, and found with certainty
  kUnseen,  ///< too few cameras to match; asked again, for others may come to see it
};

/// Is there anything left to match?
inline bool is_settled(Settled kind) { return kind != Settled::kSplit && kind != Settled::kUnseen; }

/// A level's surfels, and what matching said of each.
struct MatchedSurfels {
  std::span<const glm::vec3> positions;  ///< voxels
  std::span<const glm::vec3> bends;      ///< as curvatures() gives them, or empty
  std::span<const float> texture;        ///< Matches::texture
  std::span<const Peak> peaks;
  std::span<const ViewChoice> choices;
  std::span<const Settled> before;  ///< what the level before said
};

/// The bricks of one level's surface.
class SettledBricks {
 public:
  SettledBricks() = default;
  /// A brick is split when any of its surfels asks for it; what was settled before stays so.
  SettledBricks(const GridSpec& grid, const MatchedSurfels& surfels,
                std::span<const Camera> cameras, const SettleOptions& options);

  /// Makes it of what grid() and kinds() of another one gave, as a checkpoint keeps them.
  SettledBricks(const GridSpec& grid, std::vector<std::uint8_t> kinds)
      : grid_(grid), kinds_(std::move(kinds)) {}

  /// Of the brick at each point (voxels of `grid`); kSplit where the level had no surface.
  std::vector<Settled> at(const GridSpec& grid, std::span<const glm::vec3> positions) const;

  /// For each brick of a grid as fine or finer whether it lies in one that is settled.
  std::vector<std::uint8_t> coarse(const GridSpec& grid) const;

  std::int64_t count(Settled kind) const;

  const GridSpec& grid() const { return grid_; }
  std::span<const std::uint8_t> kinds() const { return kinds_; }

 private:
  GridSpec grid_;
  std::vector<std::uint8_t> kinds_;  // per brick of the grid: a Settled, or kNone
};

/// What a level with this surface would have settled, were it asked for the images' sampling alone:
/// kPixels in bricks where halved voxels would be below it in the view that they look at most
/// straight (whether something hides them there is not asked); the others are split.
SettledBricks settled_below_pixels(const SparseVolume& surface, std::span<const Camera> cameras,
                                   const SettleOptions& options);

}  // namespace photohull::refine

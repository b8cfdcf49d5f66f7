// From which sides photographs were taken.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/scene.h"

namespace photohull::pipeline {

/// Where a camera stands as seen from the middle of what it looks at.
struct SkyPlace {
  std::string name;      ///< of the photograph
  double azimuth = 0;    ///< radians about the upright axis, counterclockwise as seen from above
  double elevation = 0;  ///< radians above the horizon
  bool counts = false;   ///< it looks at the middle, and not steeply down or up
};

/// A part of the circle without a photograph, from `before` counterclockwise to `after`.
struct CoverageGap {
  double from = 0, to = 0;    ///< azimuths in radians, to > from
  std::string before, after;  ///< the photographs beside it

  long degrees() const;  ///< rounded
};

struct Coverage {
  std::vector<SkyPlace> places;   ///< as many as views, in their order
  std::vector<CoverageGap> gaps;  ///< of a quarter of the circle or more, the widest first
  bool judged = false;            ///< false: sides mean nothing here, and gaps are not looked for
};

/// Azimuths are about `up` (unit, world) through `middle`, from the world's x axis on, or its y
/// axis where x points up. Sides mean nothing where views do not look at one place, as in a room,
/// where most look steeply down, or where there are fewer than three.
Coverage find_coverage(std::span<const SourceView> views, const glm::dvec3& middle,
                       const glm::dvec3& up);

/// The way up (unit, world) as cameras that are held level tell it: at a right angle to their
/// horizontal axes, of which those of few sides are enough. As render::scene_up has it where they
/// do not tell.
glm::dvec3 level_up(std::span<const SourceView> views, const glm::dvec3& middle);

/// The place (world) that the views look at: the nearest to their optical axes. Where these do not
/// meet before the cameras, it is the median of the points.
glm::dvec3 find_middle(std::span<const SourceView> views, std::span<const glm::dvec3> points);

/// One sentence, with all gaps and the photographs beside them; empty where there are none.
/// `picture`: the file that shows them.
std::string coverage_warning(const Coverage& coverage, const std::string& picture);

}  // namespace photohull::pipeline

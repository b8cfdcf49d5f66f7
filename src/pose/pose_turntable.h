// Is it a turntable? The cameras' motion and the background behind the sheet together tell.
#pragma once

#include <string>
#include <vector>

#include "calib/find_turntable.h"
#include "core/progress.h"
#include "masks/still_background.h"
#include "pose/pose_job.h"
#include "sheet/draw_sheet.h"

namespace photohull::pose {

const char* to_string(Stillness stillness);

/// A turntable is one where a station's background is still.
struct TurntableFinding {
  TurntableMotion motion;
  std::vector<StillBackground> stations;  ///< of each station of the motion, where that was found
  /// Of each photograph of a station with a still background: where it can show the object, by the
  /// masks of all of them (shadows_of_hull); scaled copies of the photographs' sizes.
  std::vector<Mask> shadows;

  bool found() const { return photographs() > 0; }
  std::string reason() const;  ///< why it was not found, one sentence
  int photographs() const;     ///< of stations whose background is still
  /// Index of the photograph's station; -1: of none, or of one whose background is not still.
  int station_of(std::size_t photo) const;
  /// The still background of the photograph's station; empty where there is none.
  const StillBackground& behind(std::size_t photo) const;
  /// Says what of the photograph's look its shadow has (SheetLook::hull).
  void note_hull(std::size_t photo, SheetLook& look) const;
  /// Takes everything out of the photograph's mask that its shadow leaves out.
  void keep_to_shadow(std::size_t photo, Mask& mask) const;
};

/// Looks at the photographs again where their cameras fit a turntable. Where the job makes masks,
/// the backgrounds' light is found, first by the photographs in which the box does not cover it,
/// then by those in which the shadow of the object's hull does not, from masks of smaller pictures.
/// `edges`: of the tags in each photograph.
TurntableFinding look_for_turntable(const PoseJob& job, const Sheet& sheet,
                                    const PoseResult& result, const PhotoEdges& edges,
                                    Progress& progress);

}  // namespace photohull::pose

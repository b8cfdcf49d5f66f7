// What photographs on a sheet show together: how light falls on it, and where the object can be.
#pragma once

#include <filesystem>
#include <vector>

#include "calib/pose_photographs.h"
#include "core/image.h"
#include "core/progress.h"
#include "core/sheet_light.h"
#include "core/sheet_look.h"

namespace photohull::pose {

/// Leaves out of `values`, of a picture of that size, what a shadow leaves out, where there is one.
void keep_to(const Mask& shadow, int width, int height, std::vector<std::uint8_t>& values);

/// Says what of a picture of the sheet is in a shadow, if there is one (SheetLook::hull).
void note_hull(const Mask& shadow, SheetLook& look);

struct SheetScenery {
  SheetLight light;  ///< on the sheet; empty where photographs do not tell it
  /// Of each photograph: where it can show the object (shadows_of_hull); scaled copies of the
  /// photographs' sizes, or empty.
  std::vector<Mask> shadows;
  /// Of each photograph: 255 near tags that it should show and does not, for something may lie
  /// there; scaled copies, or empty.
  std::vector<Mask> covered;

  /// Beside the page the object can be in its shadow alone; on the page, too, where hardly any of
  /// it would be known to be bare otherwise. Where something else may lie on the sheet,
  /// the object can be in its shadow alone, too, and light is not known.
  void narrow(std::size_t photo, SheetLook& look) const;
};

/// In rounds: masks of small pictures, by the light that is known so far, give the shadows, beside
/// which more of the sheet is known to be bare. Photographs are read again each time.
/// `photos`: what each shows of the sheet. Where a tag should be and is not found, something may
/// lie on the sheet, in that photograph alone, which says nothing of the light.
SheetScenery explore_sheet(const std::vector<std::filesystem::path>& images,
                           const std::vector<PosePhoto>& photos, const Sheet& sheet,
                           const PoseResult& result, Progress& progress);

}  // namespace photohull::pose

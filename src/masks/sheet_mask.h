// Masks of an object that stands on a printed sheet, from what the sheet alone would look like.
#pragma once

#include "core/image.h"
#include "core/sheet_look.h"
#include "masks/still_background.h"

namespace photohull {

struct SheetMask {
  Mask mask;
  /// Share of the pixels where the object may be that show something else than the page, before a
  /// background of many colours: there the mask has the object, for nothing says that it is not.
  double undecided = 0;
};

/// The object, rather too large than too small. How light paper and ink are is measured where the
/// object cannot be, and continued smoothly to where it may; what differs is the object's, but
/// for shadows, as compare_with_plate says. Beside the page the background is what is seen around
/// the place. `look` has the image's size. Everything is background where the object cannot be.
/// `still`: of the same camera, or empty: beside the page the background is what it has there,
/// where it has something; where it has nothing, colours tell (background_by_colours), and the
/// object is wherever they do not. What is doubtful in it does not count where the object reaches
/// the page's edge and ends there, nor where it is a hole in the object.
SheetMask mask_from_sheet(const ColourImage& image, const SheetLook& look,
                          const StillBackground& still = {});

/// For files, which say what share of a pixel is the object's: evidence of less than a half that is
/// not beside a pixel of more, such as a shadow's edge, would be read as a thin part, and goes. So
/// do parts of less than 0.05 % of the largest one's pixels: print that is not where it should be.
void keep_shares(Mask& mask);

/// Parts of a mask that are nowhere in the object's shadow, as all photographs tell it, go: fine
/// print above all, which no picture of the sheet has as exactly as a photograph. `shadow`: 0 where
/// the object cannot be; of the mask's size or a scaled copy of it; empty: nothing is known.
void keep_parts_in(const Mask& shadow, Mask& mask);

}  // namespace photohull

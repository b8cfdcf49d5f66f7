// The steps of find_silhouettes. Private to it: each takes the views as the step before left them.
#pragma once

#include <vector>

#include "cameras/frontier.h"
#include "pipeline/find_silhouettes.h"

namespace photohull::pipeline::silhouettes {

/// The outlines of the views' masks, one each; empty where there is no mask.
using Outlines = std::vector<Outline>;

void measure_distances(std::vector<PreparedView>& views);

/// Tells the views how sharp they are beside the others, and leaves strongly blurred ones out.
void leave_out_blurred(const SilhouetteJob& job, std::vector<PreparedView>& views,
                       SilhouetteFindings& findings, Progress& progress);

/// Masks that are all too small carve the object itself away, and those that are too large leave it
/// too thick. True where stems that eaten masks had lost were put back.
bool correct_masks(const SilhouetteJob& job, std::vector<PreparedView>& views,
                   SilhouetteFindings& findings, Progress& progress);

/// Fills the silhouettes' lines.
Outlines trace_outlines(std::vector<PreparedView>& views);

/// One view that is far off carves away what all others have. Its outline goes with it.
void leave_out_wrong_views(const SilhouetteJob& job, std::vector<PreparedView>& views,
                           Outlines& outlines, SilhouetteFindings& findings, Progress& progress);

/// Pixels around each view's outline.
struct Room {
  std::vector<double> pixels;
  double full_evidence = 0;  ///< what one view's evidence is worth (carving::HullOptions)
};

/// The outline of a view that is off by a pixel would carve a pixel off the object, whatever all
/// others show. So it gets as much room as outlines tell that it is off.
Room bear_disagreement(const SilhouetteJob& job, const std::vector<PreparedView>& views,
                       const Outlines& outlines, bool restored, SilhouetteFindings& findings,
                       Progress& progress);

/// Gives stems and wires the room that voxels need; their width is known from the lines.
void give_room(const Room& room, std::vector<PreparedView>& views, SilhouetteFindings& findings);

/// Puts what masks show and not all views bear into the silhouettes that leave it out. Returns what
/// one view's evidence is worth now that this is known: masks that were made are wrong in places,
/// and none of them is believed alone.
double explain_foreground(const SilhouetteJob& job, double full_evidence,
                          std::vector<PreparedView>& views, SilhouetteFindings& findings,
                          Progress& progress);

}  // namespace photohull::pipeline::silhouettes

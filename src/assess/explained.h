// What of the photographs a surface explains, where no silhouette says what it should.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/box.h"
#include "core/mesh.h"
#include "core/prepared_view.h"
#include "raycast/ray_scene.h"

namespace photohull::assess {

/// What is known of a place on a photograph whose ray meets the box.
enum class Place : unsigned char {
  kPlain,        ///< the photograph has no texture there, so that nothing can be told
  kExplained,    ///< the surface is there, and a second view shows the same at its point
  kDisagreeing,  ///< the surface is there, and the views that see its point show something else
  kAlone,        ///< the surface is there, and no second view sees its point at a useful angle
  kBare,         ///< no surface is there, and at no depth do other views agree
  kMissed,       ///< no surface is there, and other views agree at a depth inside the box
  kCut,          ///< no surface is there, and other views agree at a depth just outside the box
  kBeyond        ///< no surface is there, and other views agree at a depth far outside the box
};
constexpr std::size_t kPlaceKinds = 8;

struct PlaceAt {
  int x = 0, y = 0;  ///< pixels
  Place place = Place::kPlain;
};

/// The places looked at in one view: a lattice, `step` pixels apart.
struct ExplainedView {
  int step = 1;
  std::vector<PlaceAt> places;
  int on_surface = 0;  ///< lattice places whose ray meets the surface, plain ones too
  int behind = 0;      ///< of these, where it is met from behind

  int count(Place place) const;
  /// Places in the box of which something is known: explained, disagreeing, alone or missed.
  int told() const;
  double explained() const;  ///< share of these, [0, 1]; 0 where there is none
};

struct Explained {
  std::vector<ExplainedView> views;
  std::array<int, kPlaceKinds> counts{};  ///< over all views, by Place

  int count(Place place) const { return counts[std::size_t(place)]; }
  int on_surface = 0, behind = 0;  ///< over all views, as of one

  int looked_at() const;  ///< places of all kinds
  /// Of the places on the surface: where a view looks at its inside, so that what hides that is
  /// missing, [0, 1].
  double share_behind() const;
  int told() const;                          ///< as of a view
  double explained() const;                  ///< as of a view
  double share_told(Place place) const;      ///< of the places told
  double share_textured(Place place) const;  ///< of all places that are not plain, [0, 1]
};

struct ExplainOptions {
  double voxel_size = 0;       ///< world units, > 0
  double pixel_size = 0;       ///< world units that a pixel covers at the object, > 0
  double noise = 0;            ///< of the photographs, standard deviation in 8-bit levels
  bool surface_alone = false;  ///< leave out places without surface, and look at a third of all
};

/// Looks at a lattice of places in every view, about 16000 in all. The window of 5 x 5 samples, a
/// pixel or a voxel apart, around a place is predicted from up to three other views that see the
/// surface at its middle (on the same side of its face, nothing before it, 5 to 60 degrees from the
/// place's ray, the nearest first): the ray of each sample meets the surface, and the point there
/// is looked up in the other view [Waechter17]. The place is explained where the zero-mean
/// normalised cross-correlation of photograph and prediction reaches kAgreement in one of them.
/// Places where the photograph's deviation is below three times its noise are plain.
///
/// Textured places without surface are searched along their rays [Collins96], from a third of the
/// distance to the box on to infinity, for the depth at which two other views correlate best with
/// the window; below kSweptAgreement in the mean none is found. Just outside the box is what is
/// nearer to it, along the ray, than a quarter of its diagonal.
///
/// The mesh needs triangles and normals. Equal input gives equal output, whatever the number of
/// threads.
Explained explain_photographs(const TriMesh& mesh, const RayScene& rays, const Box& box,
                              std::span<const PreparedView> views, const ExplainOptions& options);

}  // namespace photohull::assess

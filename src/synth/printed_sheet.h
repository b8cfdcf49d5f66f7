// A printed sheet under the object. Internal to synth.
#pragma once

#include <optional>
#include <vector>

#include "raycast/ray_scene.h"
#include "sheet/draw_sheet.h"
#include "synth/spec.h"
#include "synth/surface.h"

namespace photohull::synth {

/// The sheet in the world: its free space about the middle of the object's box, at the height of
/// the box's lowest face, its axes those of the world. How large it is beside the object is told by
/// the object before it was laid on another side.
class PrintedSheet {
 public:
  /// Reads the board. Throws Error naming its file and what is wrong with it.
  PrintedSheet(const Spec& spec, const Surface& surface);

  struct Seen {
    double t = 0;  ///< along the ray
    glm::dvec3 position{0.0};
    glm::dvec3 normal{0.0};  ///< unit, towards the side that the ray comes from
    float albedo = 0;
  };
  /// Where a ray of view `view` meets the page.
  std::optional<Seen> see(const Ray& ray, std::size_t view) const;

  glm::dvec3 origin() const { return origin_; }  ///< of the sheet's frame, world
  double unit() const { return unit_; }          ///< world units to a millimetre

 private:
  /// Something that lies on a tag, mm of the board.
  struct Disc {
    glm::dvec2 middle;
    double radius;
  };
  void hide_tags(const Sheet& sheet, const Spec& spec);
  float albedo(const glm::dvec2& place, std::size_t view) const;

  SheetPicture picture_;
  glm::dvec3 origin_{0.0};
  double unit_ = 1;
  double scale_ = 1;  ///< world units to a millimetre of the board as it is described
  double reach_ = 1;  ///< mm, at which the bend is measured
  glm::dvec3 bend_{0.0};
  std::vector<std::vector<Disc>> hidden_;  ///< of each view
};

}  // namespace photohull::synth

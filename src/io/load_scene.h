// Scenes from the folders and files of other programs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/describe.h"
#include "core/scene.h"

namespace photohull::io {

/// Where the views' masks come from.
enum class MaskSource {
  kAuto,  ///< the scene's own entries, else a masks/ folder beside the images where there is one,
          ///< else NAME_mask.png beside them
  kNone,  ///< no masks, whatever the scene says
  kBackground,  ///< made from the background, whatever masks the scene has
  kDirectory    ///< LoadSceneOptions::mask_directory, which must hold one at least
};

/// Photographs of the object by what `photohull calibrate` has calibrated. Worlds: of a rig, the
/// first camera's frame; of a turntable, z along its axis and up in the picture, the origin where
/// the axis passes nearest to the camera's optical axis, x towards the camera at angle 0; of a
/// camera that saw the board beside the object, the board's (its z points away from the cameras).
struct CalibratedImages {
  /// Rig: CAMERA.EXT, or CAMERA/ with one picture or the one that `moment` names. Turntable with
  /// `step` or `angles`: all pictures in natural order. Else those called as the board's were.
  std::filesystem::path folder;
  std::optional<double> step;  ///< turntable: degrees from one picture to the next; first at 0
  std::vector<double> angles;  ///< turntable: degrees of each picture
  std::string moment;          ///< rig: file name without extension
};

struct LoadSceneOptions {
  /// Format of the scene; detected from the files' names where absent.
  std::optional<SceneFormat> format;
  /// Coordinates of the centre of the top-left pixel in the file: 0, 0.5 or 1. Absent: the
  /// format's own convention (docs/reference/formats.md). For files whose writer
  /// followed another one.
  std::optional<double> pixel_center;
  /// Region of interest in world coordinates; replaces the scene's own. Finite. Corners that are
  /// swapped along some axis are sorted, with a warning.
  std::optional<Box> box;
  /// Where the photographs are, if not where the format has them: as listed below this folder, or
  /// by their file names in it. Of a file of `photohull calibrate`: as CalibratedImages::folder.
  /// Empty: where the format has them.
  std::filesystem::path images;
  MaskSource masks = MaskSource::kAuto;
  /// Used with kDirectory only: NAME.png, NAME.EXTENSION.png (COLMAP's way) or the image's stem
  /// with another image extension.
  /// The stem may have _mask after it.
  std::filesystem::path mask_directory;
  /// Makes a scene of these and a file of `photohull calibrate`, which has no images of its own.
  std::optional<CalibratedImages> calibrated;
  /// Photographs of the background without the object: a file for all views (a fixed camera), or a
  /// folder with one for every view, named as masks are. Empty: none. The masks are then made from
  /// the background; excludes kNone and kDirectory.
  std::filesystem::path background;
  /// Views to keep, e.g. "0-10,15,templeR0003.png,left_*": indices in file order from 0, inclusive
  /// ranges, names, shell patterns; "spread:N": N of the usable ones (spread_views.h); "all".
  /// Empty: all, or `most_views`.
  std::string views;
  /// Views to leave out of these, a list of the same kind over all views of the scene. Empty: none.
  std::string hold_out;
  /// Where `views` is empty and more photographs can be used, so many of them are taken
  /// (spread_views.h), with a warning. 0: all.
  std::size_t most_views = 0;
  /// No photograph may be missing, unreadable or of another shape: else they are left out, with a
  /// warning, while enough remain (core/left_out.h). Nor may a folder of masks lack one: else that
  /// view is used without, with a warning.
  bool strict = false;

  /// Throws UsageError naming the field and its legal values.
  void validate() const;
};

/// A photograph's listed name as a path within some folder, such as one of masks: without a root,
/// and without the `..` that it begins with.
std::filesystem::path name_within(const std::string& listed);

/// Which views are used. The box is described in pipeline/complete_box.h.
void describe_views(Described& to, LoadSceneOptions& options);
/// How the scene's files are read.
void describe_reading(Described& to, LoadSceneOptions& options);

/// What `most_views` is for commands that reconstruct: more cost time and add nothing, as measured
/// in docs/measurements/benchmarks.md, "How many views".
inline constexpr std::size_t kEnoughViews = 120;

/// Reads a scene from a folder or from the file that lists its views, in any SceneFormat
/// (docs/reference/formats.md).
/// Poses, intrinsics and pixel centres come back in the program's own conventions (core/camera.h);
/// rotations are exactly orthonormal. Image and mask sizes are read from the files' headers, no
/// pixel is decoded. The box is, in this order: options.box, bbox.txt in the scene's folder, the
/// scene file's own (aabb), README.txt of a Middlebury scene, or for COLMAP the extent of the
/// sparse points (scene_box.h). Cameras are scaled to photographs that are scaled copies of those
/// that they are for, and photographs that cannot be used are left out (usable_views.h,
/// core/left_out.h). Throws Error naming file, line or field for whatever else is missing,
/// inconsistent or not finite.
Scene load_scene(const std::filesystem::path& path, const LoadSceneOptions& options = {});

}  // namespace photohull::io

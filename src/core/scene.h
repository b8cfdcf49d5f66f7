// What a scene file says, before any image is decoded.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/box.h"
#include "core/camera.h"

namespace photohull {

enum class SceneFormat {
  kMiddlebury,
  kColmapText,
  kColmapBinary,
  kTransforms,
  kBundler,
  kNvm,
  kOpenMvg,
  kAliceVision,
  kMetashape,
  kRealityCapture,
  kStrecha,
  kPmvs,
  kMvsNet,
  kMve,
  kProjection,
  kMatlab,
  kOpenCv
};

/// The name that --format and --to know it by, such as "colmap-text".
const char* to_string(SceneFormat format);

/// One photograph as listed by the scene; in pixels of the file (distorted, not scaled).
struct SourceView {
  std::string name;             ///< unique within the scene; the image's file name
  std::filesystem::path image;  ///< exists
  std::filesystem::path mask;   ///< empty where the scene names none
  Camera camera;                ///< pixel centres already converted to (0, 0)
  Distortion distortion;
  bool silhouette = true;  ///< false: the scene says that no usable one can be cut from the picture
  bool mask_made = false;  ///< the mask was made from the photographs: it is wrong in places
  std::filesystem::path plate{};  ///< the same view without the object; empty where there is none
};

/// A surface point's places in photographs, at most one in each.
struct SceneTrack {
  struct Observation {
    int view = 0;           ///< index of the scene's views
    glm::dvec2 pixel{0.0};  ///< of the photograph as it is: with lens distortion
  };
  std::vector<Observation> observations;  ///< two or more, by ascending view
};

/// A photograph that a scene lists and that cannot be used (core/left_out.h).
struct LeftOutView {
  enum class Reason {
    kMissing,     ///< there is no such file
    kUnreadable,  ///< it is no image, or damaged
    kSize         ///< it is no scaled copy of the photograph that its camera is for
  };
  std::string name;   ///< as SourceView's
  std::string where;  ///< opens error messages: the scene's file and line, or the image's path
  Reason reason = Reason::kMissing;
  std::string detail;  ///< where was looked for it, what the decoder said, or the sizes
};

/// "missing", "unreadable" or "shape".
const char* to_string(LeftOutView::Reason reason);

/// Result of io::load_scene; only what leaves views out changes it (core/left_out.h).
struct Scene {
  std::filesystem::path path;  ///< as given
  std::filesystem::path file;  ///< what the cameras were read from: a file, or a model's folder
  SceneFormat format = SceneFormat::kMiddlebury;
  std::vector<SourceView> views;   ///< in the order of the scene file
  std::vector<glm::dvec3> points;  ///< sparse points, world; may be empty
  std::vector<SceneTrack> tracks;  ///< features that the file lists, as another program found them
  std::optional<Box> box;          ///< region of interest, world
  std::string box_source;  ///< e.g. "bbox.txt", "README.txt", option_word("box"), "sparse points"
  /// Names of all views that the file lists, in its order, used or not: what indices count in.
  std::vector<std::string> listed;
  std::vector<LeftOutView> left_out;  ///< chosen and not usable
  double usable_share = 1;            ///< of the photographs that were chosen; (0, 1]
  int scaled = 0;       ///< views whose cameras were scaled to photographs of another size
  int passed_over = 0;  ///< usable views that were not taken, for others show the same
  std::vector<std::string> warnings;
};

}  // namespace photohull

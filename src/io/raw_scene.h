// What the readers of the scene formats hand to load_scene. Internal to io.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/scene.h"

namespace photohull::io {

/// A view as its file states it, before images were looked for.
struct RawView {
  std::string listed;      ///< image name or path as written in the file
  std::string where;       ///< "FILE line 12", opens error messages
  std::string mask;        ///< mask path relative to the scene file's folder; empty: none stated
  bool mask_made = false;  ///< SourceView::mask_made
  /// Principal point in the file's pixel convention, NaN where not stated (the image's centre is
  /// meant); width and height 0 where not stated; fx and fy 0 where a field of view is.
  Camera camera;
  double angle_x = 0;  ///< horizontal field of view, radians; 0: not stated
  double angle_y = 0;  ///< vertical field of view, radians; 0: not stated
  Distortion distortion;
  bool silhouette = true;  ///< as in SourceView
};

/// A point's places as the file states them.
struct RawTrack {
  struct Observation {
    std::size_t view = 0;   ///< index of RawScene::views
    glm::dvec2 pixel{0.0};  ///< as RawScene::track_origin says, y down
  };
  std::vector<Observation> observations;
};

enum class TrackOrigin {
  kImage,     ///< coordinates of the file's own pixel convention
  kPrincipal  ///< distances from the principal point
};

struct RawScene {
  SceneFormat format = SceneFormat::kMiddlebury;
  std::filesystem::path file;  ///< the file that lists the views
  double pixel_center = 0;     ///< the format's coordinates of the top-left pixel's centre
  std::vector<RawView> views;  ///< cameras finite, rotations clean
  std::vector<glm::dvec3> points;
  std::vector<RawTrack> tracks;
  TrackOrigin track_origin = TrackOrigin::kImage;
  std::optional<Box> box;  ///< as the scene file itself states it
  std::string box_source;
  std::vector<std::filesystem::path> image_folders;  ///< where names are looked for, in order
  std::vector<std::string> warnings;
};

RawScene read_middlebury(const std::filesystem::path& par_file);
RawScene read_transforms(const std::filesystem::path& json_file);
RawScene read_colmap_text(const std::filesystem::path& model_folder);
RawScene read_colmap_binary(const std::filesystem::path& model_folder);

}  // namespace photohull::io

// The photographs' part of 'photohull evaluate'.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "core/atomic_file.h"
#include "core/mesh.h"
#include "core/progress.h"
#include "eval/photo_agreement.h"
#include "scene_arguments.h"

namespace photohull::cli {

struct PhotoArguments {
  std::optional<std::string> photos, views, lenders;
  SceneArguments scene;  ///< how the photographs are read
  std::string picture, photometric = "off";
  eval::PhotoOptions options;

  void add_to(CLI::App& command);
  bool given() const { return photos.has_value(); }
  /// Throws UsageError for values that are not understood.
  void check() const;
};

/// Sum of the weights of the stages that judge_photos announces.
inline constexpr double kPhotoWeight = 10;

/// Reads the scene, judges the mesh (called `mesh_name`) by the photographs held out, and writes
/// the picture of the worst one where `picture` is given; the caller commits it.
eval::PhotoAgreement judge_photos(const PhotoArguments& arguments, const TriMesh& mesh,
                                  const std::string& mesh_name, AtomicFile* picture,
                                  Progress& progress);

void print_agreement(const eval::PhotoAgreement& agreement);

}  // namespace photohull::cli

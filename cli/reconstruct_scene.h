// What reconstruct and scan do alike: a scene becomes a folder of results.
#pragma once

#include <filesystem>
#include <string>

#include "io/load_scene.h"
#include "pipeline/reconstruct_options.h"

namespace photohull::cli {

/// Loads the scene, reconstructs it into the folder and prints a summary, or report.json where
/// `json`. Throws as pipeline::reconstruct_to_folder does, and Error of the kind kDoubted where the
/// result failed its own checks; its files are there all the same.
void reconstruct_scene(const pipeline::ReconstructOptions& job, const io::LoadSceneOptions& load,
                       const std::filesystem::path& scene, const std::string& out, bool json);

/// What the model goes by, as a digest: program, options, the scene's files and photographs, and
/// where it goes. Throws as io::load_scene does.
std::string model_identity(const pipeline::ReconstructOptions& job,
                           const io::LoadSceneOptions& load, const std::filesystem::path& scene,
                           const std::filesystem::path& out);

/// Are all files there that report.json of the folder names?
bool has_results(const std::filesystem::path& folder);

/// Tells again what reconstruct_scene told of a folder that has results. Throws in the same way.
void tell_results(const std::string& out, bool json);

}  // namespace photohull::cli

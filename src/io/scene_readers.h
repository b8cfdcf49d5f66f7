// Each format's finder, recogniser, reader and writer, as formats.h lists them. Internal to io.
// The readers' files say where the conventions come from; docs/reference/formats.md sums them up.
#pragma once

#include <filesystem>

#include "io/load_scene.h"
#include "io/raw_scene.h"
#include "io/read_lens.h"

namespace photohull::io {

std::filesystem::path find_bundler(const std::filesystem::path& folder);
bool is_bundler(const std::filesystem::path& file);
RawScene read_bundler(const std::filesystem::path& file);
void write_bundler(const Scene& scene, const std::filesystem::path& folder);

std::filesystem::path find_nvm(const std::filesystem::path& folder);
bool is_nvm(const std::filesystem::path& file);
RawScene read_nvm(const std::filesystem::path& file);
void write_nvm(const Scene& scene, const std::filesystem::path& folder);

std::filesystem::path find_openmvg(const std::filesystem::path& folder);
bool is_openmvg(const std::filesystem::path& file);
RawScene read_openmvg(const std::filesystem::path& file);
void write_openmvg(const Scene& scene, const std::filesystem::path& folder);

std::filesystem::path find_alicevision(const std::filesystem::path& folder);
bool is_alicevision(const std::filesystem::path& file);
RawScene read_alicevision(const std::filesystem::path& file);
void write_alicevision(const Scene& scene, const std::filesystem::path& folder);

std::filesystem::path find_metashape(const std::filesystem::path& folder);
bool is_metashape(const std::filesystem::path& file);
RawScene read_metashape(const std::filesystem::path& file);
void write_metashape(const Scene& scene, const std::filesystem::path& folder);

std::filesystem::path find_realitycapture(const std::filesystem::path& folder);
bool is_realitycapture(const std::filesystem::path& file);
RawScene read_realitycapture(const std::filesystem::path& file,
                             const std::filesystem::path& images);
void write_realitycapture(const Scene& scene, const std::filesystem::path& folder);

std::filesystem::path find_strecha(const std::filesystem::path& folder);
bool is_strecha(const std::filesystem::path& file);
RawScene read_strecha(const std::filesystem::path& folder);
void write_strecha(const Scene& scene, const std::filesystem::path& folder);

std::filesystem::path find_pmvs(const std::filesystem::path& folder);
bool is_pmvs(const std::filesystem::path& file);
RawScene read_pmvs(const std::filesystem::path& folder);
void write_pmvs(const Scene& scene, const std::filesystem::path& folder);

std::filesystem::path find_mvsnet(const std::filesystem::path& folder);
bool is_mvsnet(const std::filesystem::path& file);
RawScene read_mvsnet(const std::filesystem::path& folder);
void write_mvsnet(const Scene& scene, const std::filesystem::path& folder);

std::filesystem::path find_mve(const std::filesystem::path& folder);
bool is_mve(const std::filesystem::path& file);
RawScene read_mve(const std::filesystem::path& folder);
void write_mve(const Scene& scene, const std::filesystem::path& folder);

std::filesystem::path find_projection(const std::filesystem::path& folder);
bool is_projection(const std::filesystem::path& file);
RawScene read_projection(const std::filesystem::path& path);
void write_projection(const Scene& scene, const std::filesystem::path& folder);

std::filesystem::path find_matlab(const std::filesystem::path& folder);
bool is_matlab(const std::filesystem::path& file);
RawScene read_matlab(const std::filesystem::path& file, const std::filesystem::path& images);
void write_matlab(const Scene& scene, const std::filesystem::path& folder);

std::filesystem::path find_opencv(const std::filesystem::path& folder);
bool is_opencv(const std::filesystem::path& file);
RawScene read_opencv(const std::filesystem::path& file);
void write_opencv(const Scene& scene, const std::filesystem::path& folder);

/// A file of `photohull calibrate`, and a scene of it with these photographs.
bool is_calibration(const std::filesystem::path& file);
RawScene read_calibration(const std::filesystem::path& file, const CalibratedImages& images);
/// Its lens; of a rig's file that of the camera named so.
CameraLens calibrated_lens(const std::filesystem::path& file, const std::string& camera);

}  // namespace photohull::io

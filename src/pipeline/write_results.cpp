#include "pipeline/write_results.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/error.h"
#include "core/option_word.h"
#include "core/shell_word.h"
#include "io/image_file.h"
#include "io/mesh/mesh_writers.h"
#include "io/mesh/write_mesh.h"
#include "page/make_page.h"
#include "pipeline/checkpoint_folder.h"
#include "pipeline/given_words.h"
#include "pipeline/recording_progress.h"
#include "pipeline/result_files.h"
#include "pipeline/stage_weights.h"
#include "volume/write_vdb.h"

namespace photohull::pipeline {
namespace {

/// Formats beside PLY, and how they are written.
struct ExportChoice {
  std::vector<std::string> formats;
  MeshFileOptions options;
};

/// The mesh's files: PLY, and the formats asked for.
std::vector<std::pair<std::string, const MeshWriter*>> mesh_files(
    const std::vector<std::string>& formats) {
  std::vector<std::pair<std::string, const MeshWriter*>> files;
  for (const MeshWriter& writer : mesh_writers())
    if (files.empty() || std::ranges::find(formats, writer.name) != formats.end())
      files.emplace_back(std::string("mesh.") + writer.name, &writer);
  return files;
}

/// What a job with or without evidence and a page may write.
std::vector<std::string> file_names(const std::vector<std::string>& formats, bool evidence,
                                    bool page) {
  std::vector<std::string> names = {"volume.vdb", "preview.png"};
  for (const auto& [name, writer] : mesh_files(formats)) names.push_back(name);
  if (evidence) names.insert(names.end(), {"evidence.ply", "missing.png", "explained.png"});
  if (page) names.push_back("report.html");
  names.push_back("report.json");
  return names;
}

void write_volume(const SparseVolume& volume, const VolumeAttributes& attributes,
                  const std::string& option_line, ResultFiles& files, Progress& progress) {
  const double voxel = volume.grid.voxel_size;
  if (const double unit = vdb_unit(voxel); unit != 1)
    progress.warn(concat("volume.vdb counts in ", unit,
                         " scene units (its metadata scene_unit): OpenVDB has no voxels as small "
                         "as ",
                         voxel));
  write_vdb(files.open("volume.vdb"), volume, attributes, {{"photohull_options", option_line}});
}

/// A texture goes with the mesh that it is of.
void write_meshes(const Reconstruction& result, const ExportChoice& exports, ResultFiles& files,
                  Report& report) {
  const auto open = [&](const std::string& name) -> AtomicFile& {
    report.files.push_back(name);
    return files.open(name);
  };
  for (const auto& [name, writer] : mesh_files(exports.formats)) {
    const bool textured = writer->holds_textures && result.textured;
    writer->write(open(name),
                  {textured ? result.textured->mesh : result.mesh,
                   textured ? &result.textured->texture : nullptr, result.up, exports.options},
                  open);
  }
}

void write_evidence(const Evidence& evidence, ResultFiles& files, Report& report) {
  write_ply(files.open("evidence.ply"), evidence.mesh, evidence.scalars);
  report.files.push_back("evidence.ply");
  const auto add = [&](const char* name, const MissingPicture& picture) {
    if (picture.rgb.empty()) return;  // scenes have one of the two, by whether they have masks
    io::write_png(files.open(name), picture);
    report.files.push_back(name);
  };
  add("missing.png", evidence.missing);
  add("explained.png", evidence.explained);
}

/// That makes the result again; empty for programs that have no flags.
std::string command_line(const Report& report, const std::filesystem::path& folder) {
  if (!option_word("out").starts_with("--")) return "";
  return concat("photohull reconstruct ", shell_word(report.scene.path), " ",
                option_word("out", shell_word(folder.string())), report.given_words);
}

/// The report, with what writing took, and the names of all files; the volume's is there.
Report write_rest(const Reconstruction& result, const ExportChoice& exports, ResultFiles& files,
                  Progress& given) {
  const auto start = std::chrono::steady_clock::now();
  Report report = result.report;
  const double cpu = process_cpu_seconds();
  RecordingProgress progress(given);
  StageClock clock(progress);
  clock.run("files", Weights::kFiles, [&] {
    report.files = {"volume.vdb"};
    write_meshes(result, exports, files, report);
    io::write_png(files.open("preview.png"), result.preview);
    report.files.push_back("preview.png");
    if (result.evidence) write_evidence(*result.evidence, files, report);
  });
  if (result.shown) report.files.push_back("report.html");
  report.files.push_back("report.json");
  report.stages.push_back(clock.stages().back());
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  report.wall_seconds += elapsed.count();
  report.cpu_seconds += process_cpu_seconds() - cpu;
  report.peak_memory_bytes = process_peak_memory();
  for (const std::string& text : progress.warnings()) report.warnings.push_back(text);
  const std::string text = report.to_json();
  if (result.shown) {
    const std::string page =
        page::make_page(text, command_line(report, files.folder()), *result.shown);
    files.open("report.html").write(page.data(), page.size());
  }
  files.open("report.json").write(text.data(), text.size());
  progress.check_cancelled();
  files.commit(progress);
  return report;
}

}  // namespace

Report write(const Reconstruction& result, const std::filesystem::path& folder, Progress& progress,
             const std::vector<std::string>& formats, const MeshFileOptions& mesh_files) {
  for (const std::string& format : formats) find_mesh_writer("formats", format);
  ResultFiles files(folder,
                    file_names(formats, result.evidence.has_value(), result.shown.has_value()));
  write_volume(result.volume, result.attributes, result.report.option_line, files, progress);
  return write_rest(result, {formats, mesh_files}, files, progress);
}

Report reconstruct_to_folder(const ReconstructOptions& options, const Photographs& photographs,
                             const std::filesystem::path& folder, Progress& progress) {
  ReconstructOptions with_checkpoint = options;
  with_checkpoint.checkpoint = folder;
  const Reconstructor reconstructor(with_checkpoint);
  // What can fail at once does so before the photographs are decoded.
  ResultFiles files(folder, file_names(options.exports, options.evidence,
                                       options.report_page == ReportPage::kOn));
  // The volume is written as soon as it is there, since the stages that follow need its memory.
  const auto take_volume = [&](const SparseVolume& volume, const VolumeAttributes& attributes) {
    write_volume(volume, attributes, option_line(with_checkpoint, photographs.load), files,
                 progress);
  };
  const Report report = write_rest(reconstructor.run(photographs, progress, take_volume),
                                   {options.exports, options.mesh_files}, files, progress);
  remove_checkpoint(folder);
  return report;
}

}  // namespace photohull::pipeline

#include "pipeline/join_parts.h"

#include <malloc.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/option_word.h"
#include "core/read_file.h"
#include "io/mesh/read_mesh.h"
#include "io/mesh/write_mesh.h"
#include "mesh/stitch_parts.h"
#include "pipeline/memory.h"
#include "pipeline/read_result.h"
#include "pipeline/recording_progress.h"
#include "pipeline/result_files.h"
#include "pipeline/stage_clock.h"
#include "volume/join_vdb.h"

namespace photohull::pipeline {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr double kReach = 0.75;  // voxels between vertices of two parts that are the same
// Of all volumes' largest grid, colours, and of one part's, for each of the surface's.
constexpr std::int64_t kVolumeBytes = 5;

/// What is the whole's in its report, and not how it was made.
constexpr const char* kOfTheWhole[] = {
    "photohull",         "scene",   "photographs", "inputs",  "device", "box",
    "image_scale",       "masks",   "left_out",    "verdict", "up",     "up_axis",
    "preview_png_shows", "cameras", "warnings"};

ordered_json report_in(const fs::path& folder) {
  read_report(folder);  // throws where it is none
  return ordered_json::parse(read_whole_file(folder / "report.json"));
}

/// What read(report) finds in the report of a folder.
template <typename Read>
auto told_in(const fs::path& folder, const Read& read) {
  try {
    return read(report_in(folder));
  } catch (const ordered_json::exception& problem) {
    throw Error(concat((folder / "report.json").string(), ": ", problem.what(),
                       "; make this result again"));
  }
}

/// A part may lie where nothing is left, and its mesh is empty.
bool has_surface(const fs::path& part) {
  return told_in(part, [](const ordered_json& report) {
    return report.at("mesh").at("triangles").get<std::int64_t>() > 0;
  });
}

std::vector<fs::path> volumes_of(const std::vector<fs::path>& parts) {
  std::vector<fs::path> out;
  for (const fs::path& part : parts) out.push_back(part / "volume.vdb");
  return out;
}

/// Bytes that joining takes of volumes; of meshes it takes less.
std::int64_t bytes_of_volumes(const std::vector<fs::path>& parts) {
  return kVolumeBytes * std::int64_t(joined_bytes(volumes_of(parts)));
}

void copy_into(const fs::path& from, AtomicFile& to) {
  const std::string bytes = read_whole_file(from);
  to.write(bytes.data(), bytes.size());
}

/// Joins the parts' meshes, with one of them in memory at a time, and returns what the report says
/// of that.
ordered_json join_meshes(const std::vector<fs::path>& parts, AtomicFile& file, JoinedParts& out,
                         Progress& progress) {
  std::vector<fs::path> meshes;
  for (const fs::path& part : parts)
    if (has_surface(part)) meshes.push_back(part / "mesh.ply");
  const auto each = [&](const auto& take) {
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      progress.check_cancelled();
      take(i, read_mesh(meshes[i]));
    }
  };
  PlyLayout layout{true, true, true};
  std::vector<Rim> rims;
  each([&](std::size_t, const TriMesh& mesh) {
    const PlyLayout of_part = ply_layout(mesh);
    layout.normals &= of_part.normals;
    layout.colours &= of_part.colours;
    layout.confidence &= of_part.confidence;
    layout.doubles |= of_part.doubles;
    rims.push_back(rim_of(mesh));
  });
  const Stitched stitched = stitch_rims(std::move(rims), kReach * out.voxel_size);
  layout.vertices = stitched.vertices;
  layout.triangles = stitched.triangles;
  PlyFile ply(file, layout);
  each([&](std::size_t i, TriMesh mesh) {
    ply.add_vertices(joined_part(stitched.parts[i], std::move(mesh)));
  });
  each([&](std::size_t i, TriMesh mesh) {
    ply.add_triangles(joined_part(stitched.parts[i], std::move(mesh)).triangles);
  });
  ply.add_triangles(stitched.rim);
  out.triangles = std::int64_t(stitched.triangles);
  out.seam_vertices = stitched.seam_vertices;
  out.open_edges = stitched.open_edges;
  if (stitched.open_edges > 0)
    progress.warn(concat(stitched.open_edges, " edges of mesh.ply stay open where parts meet, of ",
                         stitched.seam_vertices, " vertices there"));
  return {{"vertices", stitched.vertices},
          {"triangles", stitched.triangles},
          {"seam_vertices", stitched.seam_vertices},
          {"gaps_filled", stitched.filled},
          {"open_edges", stitched.open_edges}};
}

/// What the reports of whole and parts say of the joined one, without its files.
ordered_json joined_report(const fs::path& whole, const std::vector<fs::path>& parts,
                           const fs::path& folder, JoinedParts& out) {
  double wall = 0, cpu = 0;
  std::int64_t peak = 0;
  const auto add_costs = [&](const ordered_json& of_piece) {
    wall += of_piece.at("wall_seconds").get<double>();
    cpu += of_piece.at("cpu_seconds").get<double>();
    peak = std::max(peak, of_piece.at("peak_memory_bytes").get<std::int64_t>());
  };
  ordered_json report = told_in(whole, [&](const ordered_json& of_whole) {
    ordered_json kept;
    for (const char* key : kOfTheWhole)
      if (of_whole.contains(key)) kept[key] = of_whole[key];
    out.views = of_whole.at("scene").at("views");
    add_costs(of_whole);
    return kept;
  });
  const GridSpec grid = joined_grid(volumes_of(parts));
  out.voxel_size = grid.voxel_size;
  report["grid"] = {{"origin", {grid.origin.x, grid.origin.y, grid.origin.z}},
                    {"voxel_size", grid.voxel_size},
                    {"voxels", {grid.voxels().x, grid.voxels().y, grid.voxels().z}}};
  report["whole"] = fs::relative(whole, folder).string();
  for (const fs::path& part : parts)
    report["parts"].push_back(told_in(part, [&](const ordered_json& of_part) {
      add_costs(of_part);
      return ordered_json{{"folder", fs::relative(part, folder).string()},
                          {"box", of_part.at("box")},
                          {"triangles", of_part.at("mesh").at("triangles")}};
    }));
  report["wall_seconds"] = wall;
  report["cpu_seconds"] = cpu;
  report["peak_memory_bytes"] = peak;
  return report;
}

}  // namespace

JoinedParts join_parts(const fs::path& whole, const std::vector<fs::path>& parts,
                       const fs::path& folder, const std::optional<std::int64_t>& max_memory,
                       Progress& progress) {
  RecordingProgress heard(progress);
  JoinedParts out;
  out.verdict = read_whole_report(whole).verdict;
  ordered_json report = joined_report(whole, parts, folder, out);
  const std::int64_t bytes = bytes_of_volumes(parts),
                     limit = max_memory ? *max_memory : default_max_memory();
  out.joined = bytes <= limit;
  std::vector<std::string> names = {"mesh.ply", "preview.png", "report.json"};
  if (out.joined) names.insert(names.begin(), "volume.vdb");
  ResultFiles files(folder, names);
  if (out.joined)
    join_vdb(files.open("volume.vdb"), volumes_of(parts), {});
  else
    heard.warn(
        concat("the volumes of the parts stay by themselves: joined they would take "
               "about ",
               memory_text(bytes), " of memory, and may take ", memory_text(limit), " (",
               option_word("max_memory"), "); report.json lists the parts"));
  malloc_trim(0);  // the C library keeps what was freed
  progress.update(0.5);
  report["mesh"] = join_meshes(parts, files.open("mesh.ply"), out, heard);
  copy_into(whole / "preview.png", files.open("preview.png"));
  std::int64_t& peak = report["peak_memory_bytes"].get_ref<std::int64_t&>();
  peak = std::max(peak, process_peak_memory());
  for (const std::string& text : heard.warnings()) report["warnings"].push_back(text);
  report["files"] = names;
  const std::string text =
      report.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
  files.open("report.json").write(text.data(), text.size());
  files.commit(heard);
  return out;
}

}  // namespace photohull::pipeline

#include "pipeline/join_parts.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/option_word.h"
#include "core/read_file.h"
#include "io/mesh/read_mesh.h"
#include "io/mesh/write_mesh.h"
#include "mesh/stitch_parts.h"
#include "pipeline/memory.h"
#include "pipeline/read_result.h"
#include "pipeline/result_files.h"
#include "volume/join_vdb.h"

namespace photohull::pipeline {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr double kReach = 0.75;  // voxels between vertices of two parts that are the same
// Of a mesh in memory, for each byte of its file: doubles of what are floats there, and its border.
constexpr std::int64_t kMeshBytes = 6, kVolumeBytes = 2;

/// What is the whole's in its report, and not how it was made.
constexpr const char* kOfTheWhole[] = {
    "photohull",         "scene",  "photographs", "inputs",  "device", "box",
    "image_scale",       "masks",  "left_out",    "verdict", "up",     "up_axis",
    "preview_png_shows", "cameras"};

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

std::int64_t size_of(const fs::path& file) {
  std::error_code failure;
  const auto size = fs::file_size(file, failure);
  if (failure)
    throw Error(concat(file.string(), ": ", failure.message(), "; make this result again"));
  return std::int64_t(size);
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

/// Bytes that joining takes: of volume and mesh, which come one after the other.
std::int64_t bytes_of(const std::vector<fs::path>& parts) {
  std::int64_t mesh = 0;
  for (const fs::path& part : parts) mesh += size_of(part / "mesh.ply");
  return std::max(kMeshBytes * mesh, kVolumeBytes * std::int64_t(joined_bytes(volumes_of(parts))));
}

void copy_into(const fs::path& from, AtomicFile& to) {
  const std::string bytes = read_whole_file(from);
  to.write(bytes.data(), bytes.size());
}

/// The joined files, and what the report says of the mesh.
ordered_json write_joined(const fs::path& whole, const std::vector<fs::path>& parts,
                          ResultFiles& files, JoinedParts& out, Progress& progress) {
  const std::vector<fs::path> volumes = volumes_of(parts);
  join_vdb(files.open("volume.vdb"), volumes, {});
  progress.check_cancelled();
  progress.update(0.5);
  std::vector<TriMesh> meshes;
  for (const fs::path& part : parts)
    if (has_surface(part)) meshes.push_back(read_mesh(part / "mesh.ply"));
  Stitched stitched = stitch_parts(std::move(meshes), kReach * out.voxel_size);
  out.triangles = std::int64_t(stitched.mesh.triangles.size());
  out.seam_vertices = stitched.seam_vertices;
  out.open_edges = stitched.open_edges;
  progress.check_cancelled();
  write_ply(files.open("mesh.ply"), stitched.mesh);
  copy_into(whole / "preview.png", files.open("preview.png"));
  if (stitched.open_edges > 0)
    progress.warn(concat(stitched.open_edges, " edges of mesh.ply stay open where parts meet, of ",
                         stitched.seam_vertices, " vertices there"));
  return {{"vertices", stitched.mesh.positions.size()},
          {"triangles", stitched.mesh.triangles.size()},
          {"seam_vertices", stitched.seam_vertices},
          {"gaps_filled", stitched.filled},
          {"open_edges", stitched.open_edges}};
}

}  // namespace

JoinedParts join_parts(const fs::path& whole, const std::vector<fs::path>& parts,
                       const fs::path& folder, const std::optional<std::int64_t>& max_memory,
                       Progress& progress) {
  JoinedParts out;
  out.verdict = read_whole_report(whole).verdict;
  const GridSpec grid = joined_grid(volumes_of(parts));
  out.voxel_size = grid.voxel_size;
  double wall = 0, cpu = 0;
  const auto add_times = [&](const ordered_json& of_piece) {
    wall += of_piece.at("wall_seconds").get<double>();
    cpu += of_piece.at("cpu_seconds").get<double>();
  };
  ordered_json report = told_in(whole, [&](const ordered_json& of_whole) {
    ordered_json kept;
    for (const char* key : kOfTheWhole)
      if (of_whole.contains(key)) kept[key] = of_whole[key];
    out.views = of_whole.at("scene").at("views");
    add_times(of_whole);
    return kept;
  });
  report["grid"] = {{"origin", {grid.origin.x, grid.origin.y, grid.origin.z}},
                    {"voxel_size", grid.voxel_size},
                    {"voxels", {grid.voxels().x, grid.voxels().y, grid.voxels().z}}};
  report["whole"] = whole.filename().string();
  for (const fs::path& part : parts) {
    report["parts"].push_back(told_in(part, [&](const ordered_json& of_part) {
      add_times(of_part);
      return ordered_json{{"folder", part.filename().string()},
                          {"box", of_part.at("box")},
                          {"triangles", of_part.at("mesh").at("triangles")}};
    }));
    progress.check_cancelled();
  }
  const std::int64_t bytes = bytes_of(parts),
                     limit = max_memory ? *max_memory : default_max_memory();
  out.joined = bytes <= limit;
  std::vector<std::string> names = {"report.json"};
  if (out.joined) names = {"volume.vdb", "mesh.ply", "preview.png", "report.json"};
  ResultFiles files(folder, names);
  if (out.joined) {
    report["mesh"] = write_joined(whole, parts, files, out, progress);
  } else {
    progress.warn(concat("the parts stay by themselves: joined they would take about ",
                         memory_text(bytes), " of memory, and may take ", memory_text(limit), " (",
                         option_word("max_memory"), "); report.json lists them"));
  }
  report["wall_seconds"] = wall;
  report["cpu_seconds"] = cpu;
  report["warnings"] = ordered_json::array();
  report["files"] = names;
  const std::string text =
      report.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
  files.open("report.json").write(text.data(), text.size());
  files.commit();
  return out;
}

}  // namespace photohull::pipeline

#include "targets.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include "archive.h"
#include "calib/turntable_angles.h"
#include "cli/scene_arguments.h"
#include "core/error.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "io/mesh/read_mesh.h"
#include "io/select_views.h"
#include "io/write_scene.h"
#include "lab/chart/external.h"
#include "lab/chart/plan.h"
#include "lab/chart/results_file.h"
#include "lab/chart/stress_plan.h"
#include "lab/chart/stress_record.h"
#include "pipeline/tuning.h"
#include "refine/checkpoint.h"
#include "synth/spec.h"

namespace photohull::fuzz {
namespace fs = std::filesystem;
namespace {

template <typename Call>
void expect_success_or_error(const Call& call) {
  try {
    call();
  } catch (const Error&) {
  }
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// A scene of one format; what was read is also written.
void read_scene(SceneFormat format, std::string_view bytes) {
  const fs::path& folder = empty_folder();
  unpack(bytes, folder);
  expect_success_or_error([&] {
    io::LoadSceneOptions options;
    options.format = format;
    const Scene scene = io::load_scene(folder, options);
    io::write_scene(scene, format, folder / "written");
  });
}

/// A scene whose format is to be found, given as a folder and as each of its files.
void detect_scene(std::string_view bytes) {
  const fs::path& folder = empty_folder();
  unpack(bytes, folder);
  expect_success_or_error([&] { io::load_scene(folder); });
  for (const fs::path& file : files_in(folder))
    expect_success_or_error([&] { io::load_scene(file); });
}

/// A file of `photohull calibrate` with photographs: of a rig, or of a turntable with and without
/// steps.
void read_calibration(std::string_view bytes) {
  const fs::path& folder = empty_folder();
  unpack(bytes, folder);
  for (const std::optional<double> step : {std::optional<double>(), std::optional(30.0)})
    expect_success_or_error([&] {
      io::LoadSceneOptions options;
      options.calibrated = io::CalibratedImages{folder / "images", step, {}, ""};
      io::load_scene(folder / "calib.json", options);
    });
}

void read_pictures(std::string_view bytes) {
  constexpr std::int64_t kMostPixels = 1 << 20;  // larger ones are legal and take their memory
  const fs::path& folder = empty_folder();
  unpack(bytes, folder);
  for (const fs::path& file : files_in(folder))
    expect_success_or_error([&] {
      const io::ImageSize size = io::read_image_size(file);
      if (std::int64_t(size.width) * size.height > kMostPixels) return;
      expect_success_or_error([&] { io::read_mask(file); });
      io::read_image(file);
    });
}

void read_meshes(std::string_view bytes, const char* name) {
  const fs::path file = empty_folder() / name;
  std::ofstream(file, std::ios::binary) << bytes;
  expect_success_or_error([&] { read_mesh(file, Faces::kOptional); });
}

void read_synthetic_spec(std::string_view bytes) {
  expect_success_or_error([&] {
    const synth::Spec spec = synth::parse_spec(std::string(bytes), "spec.json", "/nowhere");
    const std::string text = synth::spec_text(spec);
    if (synth::spec_text(synth::parse_spec(text, "again", "/nowhere")) != text)
      check_failed(__FILE__, __LINE__, "a spec does not read back to itself");
  });
}

void read_chart_files(std::string_view bytes) {
  const fs::path& folder = empty_folder();
  unpack(bytes, folder);
  expect_success_or_error([&] { chart::read_plan(folder / "plan.json"); });
  expect_success_or_error([&] { chart::read_results(folder / "results.json"); });
  for (const char* name : {"external.csv", "external.json"})
    expect_success_or_error([&] { chart::read_external(folder / name); });
}

/// A plan of degradations, and the record of one of its runs.
void read_stress_files(std::string_view bytes) {
  const fs::path& folder = empty_folder();
  unpack(bytes, folder);
  expect_success_or_error([&] { chart::read_stress_plan(folder / "plan.json"); });
  const fs::path record = folder / "record.json";
  expect_success_or_error(
      [&] { chart::figures_of(chart::StressRecord::from_json(record, chart::read_json(record))); });
}

std::vector<std::string> lines_of(std::string_view bytes) {
  std::vector<std::string> lines(1);
  for (const char c : bytes)
    if (c == '\n')
      lines.emplace_back();
    else
      lines.back() += c;
  return lines;
}

/// The words of a command line about a scene, one a line.
void read_scene_arguments(std::string_view bytes) {
  std::vector<std::string> words = lines_of(bytes);
  for (const std::string& word : words)
    expect_success_or_error([&] {
      TurntableAngles angles;
      Described described;
      describe(described, angles);
      read_option(*described.find("angles"), word);
    });
  expect_success_or_error([&] {
    CLI::App command;
    cli::SceneArguments arguments;
    arguments.add_to(command);
    try {
      std::reverse(words.begin(), words.end());  // as the parser takes them
      command.parse(words);
    } catch (const CLI::ParseError&) {
      return;  // the program prints its message
    }
    arguments.check();
  });
}

/// Assignments of --tune, one a line.
void read_tuning(std::string_view bytes) {
  const std::vector<std::string> assignments = lines_of(bytes);
  for (const pipeline::Method method : {pipeline::Method::kSpaceCarving, pipeline::Method::kRefine})
    expect_success_or_error([&] {
      pipeline::Parameters parameters;
      pipeline::tune(assignments, method, parameters);
    });
}

void read_view_list(std::string_view bytes) {
  static const std::vector<std::string> names = {"a.png", "b.png", "view10.png", "view2.png",
                                                 "0",     "1-2",   "x[1].png",   "*"};
  expect_success_or_error([&] { io::select_views(std::string(bytes), names); });
}

/// A checkpoint as it is written, on two bricks along each axis.
std::string intact_checkpoint(const fs::path& file, const GridSpec& grid) {
  refine::Checkpoint level;
  level.volume.grid = grid;
  level.volume.table.assign(grid.brick_count(), SparseVolume::kOutside);
  level.volume.table[0] = 0;
  level.volume.bricks = {glm::ivec3(0)};
  level.volume.distance.assign(kBrickVoxels, 1.0f);
  level.settled = refine::SettledBricks(
      grid, std::vector<std::uint8_t>(grid.brick_count(), std::uint8_t(refine::Settled::kFlat)));
  level.levels.resize(1);
  refine::write_checkpoint({file, "digest"}, level);
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A checkpoint damaged as the bytes say: the first is the share of it that is there, in 255ths; of
/// every three that follow two are a place, and the third is what the byte there is XORed with.
/// What cannot be read is a warning and no checkpoint.
void read_level(std::string_view bytes) {
  const fs::path file = empty_folder() / "checkpoint";
  const GridSpec coarse{glm::dvec3(0), 1.0, glm::ivec3(2)};
  const GridSpec fine{glm::dvec3(0), 0.5, glm::ivec3(4)};
  const GridSpec grids[] = {coarse, fine};
  static const std::string intact = intact_checkpoint(file, coarse);
  std::string damaged = intact;
  const auto byte = [&](std::size_t i) {
    return std::size_t(static_cast<unsigned char>(bytes[i]));
  };
  for (std::size_t i = 1; i + 2 < bytes.size(); i += 3)
    damaged[(byte(i) << 8 | byte(i + 1)) % damaged.size()] ^= char(byte(i + 2));
  if (!bytes.empty()) damaged.resize(damaged.size() * byte(0) / 255);
  std::ofstream(file, std::ios::binary) << damaged;
  Progress silent;
  expect_success_or_error([&] {
    const auto level = refine::read_checkpoint({file, "digest"}, grids, silent);
    if (damaged == intact && !level)
      check_failed(__FILE__, __LINE__, "an intact checkpoint is not read");
    if (level) level->settled.count(refine::Settled::kFlat);
  });
}

std::vector<Target> make_targets() {
  std::vector<Target> all;
  for (const SceneFormat format : io::scene_formats())
    all.push_back({concat("scene-", to_string(format)),
                   [format](std::string_view bytes) { read_scene(format, bytes); }});
  all.push_back({"scene-detect", detect_scene});
  all.push_back({"scene-calibration", read_calibration});
  all.push_back({"images", read_pictures});
  for (const char* kind : {"ply", "obj", "off", "stl", "glb", "gltf"})
    all.push_back({concat("mesh-", kind), [name = concat("mesh.", kind)](std::string_view bytes) {
                     read_meshes(bytes, name.c_str());
                   }});
  all.push_back({"spec", read_synthetic_spec});
  all.push_back({"chart", read_chart_files});
  all.push_back({"stress", read_stress_files});
  all.push_back({"scene-arguments", read_scene_arguments});
  all.push_back({"tune", read_tuning});
  all.push_back({"view-list", read_view_list});
  all.push_back({"checkpoint", read_level});
  return all;
}

}  // namespace

const std::vector<Target>& targets() {
  static const std::vector<Target> all = make_targets();
  return all;
}

const Target* find_target(std::string_view name) {
  for (const Target& target : targets())
    if (target.name == name) return &target;
  return nullptr;
}

}  // namespace photohull::fuzz

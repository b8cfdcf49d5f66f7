#include "damaged_scenes.h"

#include <fnmatch.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>

#include "child_process.h"
#include "core/error.h"
#include "damaged_pictures.h"
#include "sphere_scene.h"
#include "support/scratch_folder.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A block seen from all around, against black.
json sound_spec() {
  return json::parse(R"({
    "geometry": {"shape": "block"},
    "image": {"width": 160, "height": 120, "samples": 2, "maps": false},
    "cameras": {"layout": "hemisphere", "count": 12, "lowest": -20, "highest": 70, "fill": 0.9},
    "truth_samples": 500})");
}

struct Cached {
  ScratchFolder folder;
  fs::path scene;
};

json read_json(const fs::path& file) { return json::parse(read_bytes(file)); }
void write_json(const fs::path& file, const json& j) { write_bytes(file, j.dump(1)); }

/// Rows of the matrix of a frame of transforms.json.
json& matrix(json& scene, std::size_t view) { return scene["frames"][view]["transform_matrix"]; }

/// Changes transforms.json of the folder's scene.
void edit_cameras(const fs::path& folder, const std::function<void(json&)>& change) {
  const fs::path file = folder / "scene/transforms.json";
  json scene = read_json(file);
  change(scene);
  write_json(file, scene);
}

/// The first three rows of a frame's matrix, each times a factor for every column.
void scale_columns(json& frame, const std::array<double, 4>& factors) {
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 4; ++column) {
      json& value = frame["transform_matrix"][row][column];
      value = value.get<double>() * factors[column];
    }
}

/// World to camera where camera to world is asked for.
void invert_pose(json& frame) {
  json& m = frame["transform_matrix"];
  const json old = m;
  for (std::size_t row = 0; row < 3; ++row) {
    double place = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      m[row][k] = old[k][row];
      place -= old[k][row].get<double>() * old[k][3].get<double>();
    }
    m[row][3] = place;
  }
}

void move_to_first(json& scene) {
  for (json& frame : scene["frames"])
    for (std::size_t row = 0; row < 3; ++row)
      frame["transform_matrix"][row][3] = matrix(scene, 0)[row][3];
}

using Damage = std::function<void(const fs::path& folder, const json& m)>;

/// A mistake with the whole of transforms.json.
Damage whole(const std::function<void(json& scene, const json& m)>& change) {
  return [change](const fs::path& folder, const json& m) {
    edit_cameras(folder, [&](json& scene) { change(scene, m); });
  };
}

/// A mistake with every frame of transforms.json.
Damage frames(const std::function<void(json& frame, const json& m)>& change) {
  return whole([change](json& scene, const json& m) {
    for (json& frame : scene["frames"]) change(frame, m);
  });
}

const std::map<std::string, Damage>& camera_damages() {
  using Factors = std::array<double, 4>;
  static const std::map<std::string, Damage> all = {
      {"swap cameras",
       whole([](json& s, const json& m) { std::swap(matrix(s, m[1]), matrix(s, m[2])); })},
      {"move cameras to one place", whole([](json& s, const json&) { move_to_first(s); })},
      {"turn camera upside down", whole([](json& s, const json& m) {
         scale_columns(s["frames"][m[1].get<std::size_t>()], Factors{-1, -1, 1, 1});
       })},
      {"keep views", whole([](json& s, const json& m) {
         s["frames"].erase(s["frames"].begin() + m[1].get<long>(), s["frames"].end());
       })},
      {"scale columns of matrices",
       frames([](json& frame, const json& m) { scale_columns(frame, m[1].get<Factors>()); })},
      {"invert poses", frames([](json& frame, const json&) { invert_pose(frame); })},
      {"set in frames",
       frames([](json& frame, const json& m) { frame[m[1].get<std::string>()] = m[2]; })},
      {"scale in frames", frames([](json& frame, const json& m) {
         json& value = frame[m[1].get<std::string>()];
         value = value.get<double>() * m[2].get<double>();
       })},
      {"prefix paths", frames([](json& frame, const json& m) {
         for (const char* name : {"file_path", "mask_path"}) {
           std::string path = frame[name];
           std::replace(path.begin(), path.end(), '/', '\\');
           frame[name] = m[1].get<std::string>() + path;
         }
       })},
  };
  return all;
}

/// A mistake with each of the files that m[1] names.
Damage each(const std::function<void(const fs::path& file, const json& m)>& change) {
  return [change](const fs::path& folder, const json& m) {
    for (const fs::path& file : files_named(folder, m[1])) change(file, m);
  };
}

void cut_short(const fs::path& file, const json& m) {
  fs::resize_file(file, std::uintmax_t(double(fs::file_size(file)) * m[2].get<double>()));
}

void set_field(const fs::path& file, const json& m) {
  json j = read_json(file);
  j[json::json_pointer(m[2].get<std::string>())] = m[3];
  write_json(file, j);
}

void forbid(const fs::path& file, const json&) { fs::permissions(file, fs::perms::none); }

void forbid_writing(const fs::path& file, const json&) {
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_exec);
}

const std::map<std::string, Damage>& file_damages() {
  const auto second = [](const fs::path& folder, const json& m) {
    return folder / m[2].get<std::string>();
  };
  static const std::map<std::string, Damage> all = {
      {"remove", each([](const fs::path& file, const json&) { fs::remove_all(file); })},
      {"empty", each([](const fs::path& file, const json&) { write_bytes(file, ""); })},
      {"cut short", each(cut_short)},
      {"forbid", each(forbid)},
      {"forbid writing", each(forbid_writing)},
      {"set", each(set_field)},
      {"replace", each([](const fs::path& file, const json& m) { edit(file, m[2], m[3]); })},
      {"write",
       [](const fs::path& folder, const json& m) {
         const fs::path file = folder / m[1].get<std::string>();
         fs::create_directories(file.parent_path());
         write_bytes(file, m[2]);
       }},
      {"make folder",
       [](const fs::path& folder, const json& m) {
         fs::create_directories(folder / m[1].get<std::string>());
       }},
      {"copy",
       [second](const fs::path& folder, const json& m) {
         fs::copy(folder / m[1].get<std::string>(), second(folder, m),
                  fs::copy_options::recursive | fs::copy_options::overwrite_existing);
       }},
      {"move",
       [second](const fs::path& folder, const json& m) {
         fs::rename(folder / m[1].get<std::string>(), second(folder, m));
       }},
      {"add suffix", each([](const fs::path& file, const json& m) {
         const std::string suffix = m[2];
         fs::rename(file, file.parent_path() / (file.stem().string() + suffix));
       })},
      {"another scene",
       [](const fs::path& folder, const json& m) {
         fs::copy(sound_scene(m[2]), folder / m[1].get<std::string>(), fs::copy_options::recursive);
       }},
  };
  return all;
}

}  // namespace

const fs::path& sound_scene(const json& patch) {
  static std::map<std::string, std::unique_ptr<Cached>> made;
  std::unique_ptr<Cached>& entry = made[patch.dump()];
  if (entry) return entry->scene;
  entry = std::make_unique<Cached>();
  entry->scene = entry->folder / "scene";
  json spec = sound_spec();
  if (patch.is_object()) spec.merge_patch(patch);
  write_json(entry->folder / "spec.json", spec);
  const Finished run = run_photohull({"synthesize", (entry->folder / "spec.json").string(), "--out",
                                      entry->scene.string(), "--threads", "1"});
  if (run.code != 0) throw std::runtime_error("no scene was made: " + run.err);
  return entry->scene;
}

std::vector<fs::path> files_named(const fs::path& folder, const std::string& pattern) {
  if (pattern.find_first_of("*[") == std::string::npos) return {folder / pattern};
  const fs::path whole = folder / pattern;
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(whole.parent_path()))
    if (fnmatch(whole.filename().c_str(), entry.path().filename().c_str(), 0) == 0)
      found.push_back(entry.path());
  if (found.empty()) throw std::runtime_error(pattern + " names no file");
  std::sort(found.begin(), found.end());
  return found;
}

void damage(const fs::path& folder, const json& mistake) {
  const std::string name = mistake.at(0);
  if (damage_pictures(folder, mistake)) return;
  for (const auto* kind : {&file_damages(), &camera_damages()})
    if (const auto found = kind->find(name); found != kind->end())
      return found->second(folder, mistake);
  throw std::runtime_error("there is no damage called " + name);
}

}  // namespace photohull::test

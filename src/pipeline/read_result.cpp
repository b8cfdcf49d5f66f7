#include "pipeline/read_result.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/json_levels.h"
#include "core/nearest_name.h"
#include "core/option_word.h"
#include "core/read_file.h"
#include "io/mesh/read_mesh.h"
#include "io/mesh/read_textured.h"

namespace photohull::pipeline {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kLargestSide = 1 << 20;  // pixels of a photograph

/// report.json, with errors that name it.
class ReportFile {
 public:
  explicit ReportFile(const fs::path& path) : path_(path) {
    const std::string text = read_whole_file(path);
    root_ = json::parse(text, json_level_guard(path.string()), false);
    if (!root_.is_object()) fail("it is no JSON object");
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(concat(path_.string(), ": ", what,
                       "; give a folder that 'photohull reconstruct' wrote, or reconstruct again"));
  }
  const json& root() const { return root_; }
  const json& at(const json& object, const char* key) const {
    const auto found = object.find(key);
    if (found == object.end()) fail(concat("\"", key, "\" is missing"));
    return *found;
  }
  std::vector<double> numbers(const json& object, const char* key, std::size_t count) const {
    const json& list = at(object, key);
    std::vector<double> out;
    if (list.is_array() && list.size() == count)
      for (const json& value : list)
        if (value.is_number() && std::isfinite(value.get<double>()))
          out.push_back(value.get<double>());
    if (out.size() != count) fail(concat("\"", key, "\" is no list of ", count, " numbers"));
    return out;
  }
  glm::dvec3 vector(const json& object, const char* key) const {
    const std::vector<double> v = numbers(object, key, 3);
    return {v[0], v[1], v[2]};
  }
  std::string text(const json& object, const char* key) const {
    const json& value = at(object, key);
    if (!value.is_string()) fail(concat("\"", key, "\" is no text"));
    return value.get<std::string>();
  }

 private:
  fs::path path_;
  json root_;
};

CameraPose read_camera(const ReportFile& report, const json& view) {
  if (!view.is_object()) report.fail("one of \"cameras\" is no object");
  CameraPose out{report.text(view, "name"), {}};
  const auto size = report.numbers(view, "size", 2), focal = report.numbers(view, "focal", 2),
             principal = report.numbers(view, "principal", 2);
  for (const double side : size)
    if (!(side >= 1 && side <= kLargestSide))
      report.fail("a camera's \"size\" is none of a photograph");
  const json& skew = report.at(view, "skew");
  if (!skew.is_number() || !(focal[0] > 0 && focal[1] > 0))
    report.fail("a camera's \"focal\" or \"skew\" is no usable number");
  out.camera.intrinsics = {int(size[0]),       int(size[1]), focal[0],    focal[1],
                           skew.get<double>(), principal[0], principal[1]};
  const json& rows = report.at(view, "rotation");
  if (!rows.is_array() || rows.size() != 3)
    report.fail("a camera's \"rotation\" has not three rows");
  glm::dmat3& r = out.camera.cam_from_world.rotation;
  for (int row = 0; row < 3; ++row) {
    const auto numbers = report.numbers({{"rotation", rows[std::size_t(row)]}}, "rotation", 3);
    for (int column = 0; column < 3; ++column) r[column][row] = numbers[std::size_t(column)];
  }
  const glm::dmat3 product = r * glm::transpose(r);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(product[i][k] - (i == k)) < 1e-6))
        report.fail("a camera's \"rotation\" is none");
  out.camera.cam_from_world.translation = -(r * report.vector(view, "centre"));
  return out;
}

LookFindings read_look(const ReportFile& report) {
  LookFindings look;
  const json& root = report.root();
  if (!root.contains("cameras"))
    report.fail("it tells no cameras, for it is of an older version of photohull");
  look.up = report.vector(root, "up");
  look.up_axis = report.vector(root, "up_axis");
  if (!(std::abs(glm::length(look.up) - 1) < 1e-6)) report.fail("\"up\" is no unit vector");
  look.main_view = report.text(root, "preview_png_shows");
  const json& cameras = root["cameras"];
  if (!cameras.is_array()) report.fail("\"cameras\" is no list");
  for (const json& view : cameras) look.cameras.push_back(read_camera(report, view));
  return look;
}

Box read_box(const ReportFile& report) {
  const json& root = report.root();
  if (!root.contains("box")) report.fail("it has no \"box\"");
  const Box box{report.vector(root["box"], "min"), report.vector(root["box"], "max")};
  if (!glm::all(glm::lessThan(box.min, box.max))) report.fail("\"box\" holds nothing");
  return box;
}

std::vector<std::string> texts(const ReportFile& report, const json& object, const char* key) {
  std::vector<std::string> out;
  for (const json& text : report.at(object, key)) {
    if (!text.is_string()) report.fail(concat("\"", key, "\" holds something other than text"));
    out.push_back(text.get<std::string>());
  }
  return out;
}

VerdictFindings read_verdict(const ReportFile& report) {
  VerdictFindings out;
  const auto found = report.root().find("verdict");
  if (found == report.root().end()) report.fail("it has no \"verdict\"");
  const std::string level = report.text(*found, "level");
  for (const auto known :
       {assess::Level::kGood, assess::Level::kDoubtful, assess::Level::kFailed}) {
    if (level != assess::to_string(known)) continue;
    out.verdict.level = known;
    out.verdict.reasons = texts(report, *found, "reasons");
    out.verdict.notes = texts(report, *found, "notes");
    out.verdict.coverage = report.text(*found, "coverage");
    out.json = found->dump();
    return out;
  }
  report.fail("its \"verdict\" has no \"level\" that is known");
}

/// Of vertices that have none: means of their triangles' normals, by area.
void complete_normals(TriMesh& mesh) {
  if (mesh.normals.size() == mesh.positions.size()) return;
  mesh.normals.assign(mesh.positions.size(), glm::vec3(0));
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::vec3 normal =
        glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
    for (const std::uint32_t v : {a, b, c}) mesh.normals[v] += normal;
  }
  for (glm::vec3& n : mesh.normals)
    if (const float length = glm::length(n); length > 0) n /= length;
}

bool has_texture(const ReportFile& report) {
  const auto files = report.root().find("files");
  return report.root().contains("texture") && files != report.root().end() && files->is_array() &&
         std::ranges::find(*files, "mesh.glb") != files->end();
}

/// The file of a folder of results.
fs::path report_of(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::exists(folder, ignored))
    throw Error(concat(folder.string(), ": there is no such folder"));
  if (!fs::is_directory(folder, ignored))
    throw Error(concat(folder.string(), ": this is a file; give the folder of the results"));
  const fs::path path = folder / "report.json";
  if (!fs::is_regular_file(path, ignored))
    throw Error(concat(folder.string(),
                       " has no report.json, so no result is there: 'photohull reconstruct SCENE ",
                       option_word("out"), " ", folder.string(), "' writes one"));
  return path;
}

}  // namespace

ResultReport read_report(const fs::path& folder) {
  const ReportFile report(report_of(folder));
  const json& root = report.root();
  const auto photometric = root.find("photometric"), followed = root.find("followed");
  if (followed != root.end() && !followed->is_boolean())
    report.fail("\"followed\" is neither true nor false");
  return {read_look(report), photometric == root.end() ? std::string() : photometric->dump(),
          followed != root.end() && followed->get<bool>()};
}

WholeReport read_whole_report(const fs::path& folder) {
  const ReportFile report(report_of(folder));
  WholeReport out{read_box(report), read_verdict(report), {}};
  if (report.root().contains("hull_trust"))
    out.hull_trust =
        report.numbers(report.root(), "hull_trust", RefineFindings::HullTrust().size());
  return out;
}

std::vector<std::string> listed_files(const fs::path& folder) {
  try {
    const ReportFile report(folder / "report.json");
    return texts(report, report.root(), "files");
  } catch (const Error&) {
    return {};
  }
}

ResultModel read_result(const fs::path& folder) {
  const ReportFile report(report_of(folder));
  ResultModel out;
  out.look = read_look(report);
  if (has_texture(report)) {
    out.textured = read_textured_glb(folder / "mesh.glb", out.look.up_axis);
  } else {
    out.mesh = read_mesh(folder / "mesh.ply");
    complete_normals(out.mesh);
  }
  return out;
}

const CameraPose& find_camera(const LookFindings& look, const std::string& view) {
  const auto named = std::ranges::find(look.cameras, view, &CameraPose::name);
  if (named != look.cameras.end()) return *named;
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(view.data(), view.data() + view.size(), index);
  if (error == std::errc() && end == view.data() + view.size() && !view.empty() &&
      index < look.cameras.size())
    return look.cameras[index];
  std::vector<std::string> names;
  for (const CameraPose& pose : look.cameras) names.push_back(pose.name);
  const auto meant = nearest_name(view, names);
  throw Error(concat(option_word("camera", view), ": the result has no such view; give a name, ",
                     meant ? concat("such as ", *meant, ", ") : std::string(),
                     "or an index from 0 to ", look.cameras.size() - 1));
}

}  // namespace photohull::pipeline

#include "pipeline/measure_result.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/read_file.h"
#include "io/mesh/read_mesh.h"
#include "pipeline/read_result.h"

namespace photohull::pipeline {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json array_of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

Json json_of(const Measured& m) { return {{"value", m.value}, {"uncertainty", m.uncertainty}}; }

double voxel_size_of(const fs::path& report) {
  const Json json = Json::parse(read_whole_file(report), nullptr, false);
  const Json::json_pointer place("/grid/voxel_size");
  if (!json.is_object() || !json.contains(place) || !json.at(place).is_number() ||
      !(json.at(place).get<double>() > 0))
    throw Error(report.string() +
                ": \"grid\" has no \"voxel_size\"; give a folder that 'photohull reconstruct' "
                "wrote");
  return json.at(place).get<double>();
}

/// Column and value; an open mesh has no volume.
std::vector<std::pair<std::string, std::string>> columns_of(const Measurements& m) {
  std::vector<std::pair<std::string, std::string>> out;
  const auto add = [&](const std::string& name, double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value);
    out.emplace_back(name, text);
  };
  const auto add_measured = [&](const std::string& name, const Measured& measured) {
    add(name, measured.value);
    add(name + "_uncertainty", measured.uncertainty);
  };
  if (m.volume)
    add_measured("volume", *m.volume);
  else
    out.insert(out.end(), {{"volume", ""}, {"volume_uncertainty", ""}});
  add_measured("area", m.area);
  add_measured("height", m.height);
  add_measured("hull_volume", m.hull_volume);
  add_measured("box_volume", m.box_volume);
  const char* axes[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) add(std::string("box_") + axes[i], m.box.size()[i]);
  for (int i = 0; i < 3; ++i) add("oriented_box_" + std::to_string(i + 1), m.oriented.size[i]);
  add("unseen", m.unseen);
  return out;
}

/// As tables have text: quoted where it holds what would end it.
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

Measurements measure(const Reconstruction& result, const MeasureOptions& options) {
  return photohull::measure(result.mesh, result.report.look.up_axis, result.report.grid.voxel_size,
                            options);
}

Measurements measure_folder(const fs::path& folder, const MeasureOptions& options) {
  options.validate();
  const ResultModel result = read_result(folder);
  return photohull::measure(read_mesh(folder / "mesh.ply"), result.look.up_axis,
                            voxel_size_of(folder / "report.json"), options);
}

std::string to_json(const Measurements& m) {
  Json j;
  j["closed"] = m.closed;
  j["volume"] = m.volume ? json_of(*m.volume) : Json();
  j["area"] = json_of(m.area);
  j["axis"] = array_of(m.axis);
  j["height"] = json_of(m.height);
  j["box"] = {{"min", array_of(m.box.min)},
              {"max", array_of(m.box.max)},
              {"volume", json_of(m.box_volume)}};
  j["oriented_box"] = {
      {"center", array_of(m.oriented.center)},
      {"axes",
       {array_of(m.oriented.axes[0]), array_of(m.oriented.axes[1]), array_of(m.oriented.axes[2])}},
      {"size", array_of(m.oriented.size)}};
  j["hull_volume"] = json_of(m.hull_volume);
  j["sections"] = Json::array();
  for (const CrossSection& s : m.sections)
    j["sections"].push_back({{"position", s.position}, {"area", json_of(s.area)}});
  j["unseen"] = m.unseen;
  return j.dump(2) + "\n";
}

std::string csv_head() {
  std::string line = "name";
  Measurements any;
  for (const auto& [name, value] : columns_of(any)) line += "," + name;
  return line;
}

std::string csv_row(const std::string& name, const Measurements& measured) {
  std::string line = csv_text(name);
  for (const auto& [column, value] : columns_of(measured)) line += "," + value;
  return line;
}

}  // namespace photohull::pipeline

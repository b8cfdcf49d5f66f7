#include "batch/outcome.h"

#include <nlohmann/json.hpp>
#include <sstream>

namespace photohull::batch {
namespace {

using nlohmann::json;

/// In quotes where it has to be.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

}  // namespace

std::string to_json(const std::string& name, const Outcome& o) {
  return json{{"name", name},
              {"identity", o.identity},
              {"plan", o.plan},
              {"scene", o.scene},
              {"verdict", o.verdict},
              {"message", o.message},
              {"exit_code", o.exit_code},
              {"views", o.views},
              {"voxel_size", o.voxel_size},
              {"triangles", o.triangles},
              {"wall_seconds", o.wall_seconds},
              {"cpu_seconds", o.cpu_seconds},
              {"peak_memory_bytes", o.peak_memory_bytes}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string to_json(const std::string& name, const std::optional<Outcome>& outcome) {
  if (outcome) return to_json(name, *outcome);
  return json{{"name", name}}.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::optional<Outcome> outcome_from_json(const std::string& text) {
  try {
    const json j = json::parse(text);
    Outcome o;
    j.at("identity").get_to(o.identity);
    j.at("plan").get_to(o.plan);
    j.at("scene").get_to(o.scene);
    j.at("verdict").get_to(o.verdict);
    j.at("message").get_to(o.message);
    j.at("exit_code").get_to(o.exit_code);
    j.at("views").get_to(o.views);
    j.at("voxel_size").get_to(o.voxel_size);
    j.at("triangles").get_to(o.triangles);
    j.at("wall_seconds").get_to(o.wall_seconds);
    j.at("cpu_seconds").get_to(o.cpu_seconds);
    j.at("peak_memory_bytes").get_to(o.peak_memory_bytes);
    return o;
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

std::string table_of(std::span<const Row> rows) {
  std::ostringstream out;
  out << "name,scene,verdict,exit_code,views,voxel_size,triangles,wall_seconds,cpu_seconds,"
         "peak_memory_bytes,message\n";
  for (const auto& [name, outcome] : rows) {
    out << field(name) << ',';
    if (!outcome) {
      out << ",,,,,,,,,not made yet\n";
      continue;
    }
    const Outcome& o = *outcome;
    out << field(o.scene) << ',' << o.verdict << ',' << o.exit_code << ',';
    if (o.has_result())
      out << o.views << ',' << o.voxel_size << ',' << o.triangles << ',';
    else
      out << ",,,";
    out << o.wall_seconds << ',' << o.cpu_seconds << ',' << o.peak_memory_bytes << ','
        << field(o.message) << '\n';
  }
  return out.str();
}

}  // namespace photohull::batch

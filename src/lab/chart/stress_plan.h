// What is degraded, how far, and what is to be compared: a JSON file
// (docs/measurements/stability.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lab/chart/json_fields.h"

namespace photohull::chart {

/// A synthetic scene's spec as a JSON object.
struct StressScene {
  std::string name;        ///< unique; letters, digits and "._-"
  Json spec;               ///< complete but for the seed; mesh files by absolute path
  bool on_demand = false;  ///< only on axes that name it
};

/// An option set of `photohull reconstruct`.
struct StressVariant {
  std::string name;                    ///< unique
  std::vector<std::string> arguments;  ///< the plan's common ones included
  bool on_demand = false;              ///< only on axes that name it
};

/// One degree of a degradation.
struct StressPoint {
  double strength = 0;                 ///< place on the axis; of kinds: 1, 2, 3 ...
  std::string label;                   ///< the strength as text, or the kind's name
  Json spec = Json::object();          ///< merged into the scene's (RFC 7386)
  std::vector<std::string> arguments;  ///< replace those of the variant that have the same name
};

/// A promise: F-scores at every point from clean to this one stay above the share.
struct StressMark {
  std::string text;
  std::size_t point = 0;  ///< the last one that counts
  std::string variant;
};

/// One degradation, from clean to hopeless.
struct StressAxis {
  std::string name, title, group, unit;
  bool log = false;                 ///< drawn and interpolated in logarithms
  bool kinds = false;               ///< points are kinds without an order
  bool same_mesh = false;           ///< every point is to give the clean mesh, byte by byte
  StressPoint clean;                ///< what F-scores are compared with
  std::vector<StressPoint> points;  ///< away from clean, strictly monotone unless kinds
  std::vector<std::size_t> scenes, variants;  ///< indices in the plan
  std::vector<StressMark> marks;
};

struct StressPlan {
  std::filesystem::path file;
  std::string title;
  std::vector<StressScene> scenes;
  std::vector<StressVariant> variants;
  std::vector<StressAxis> axes;
  std::vector<std::uint64_t> seeds = {1};
  double time_limit_seconds = 600;  ///< of a reconstruction
  double kept = 0.9;                ///< share of the clean F-score below which it is broken
  double mark_percent = 0.25;       ///< threshold of the marks' F-score, percent of the diagonal
};

struct StressSelection {
  std::vector<std::string> axes;     ///< names; empty: all
  std::vector<std::uint64_t> seeds;  ///< empty: the plan's
};

/// A spec with every default written out, by which equal scenes are known; throws Error that opens
/// with `source` when the text is no spec.
using NormalizeSpec =
    std::function<std::string(const std::string& text, const std::string& source)>;

/// Reads a plan; paths in it are relative to its own folder. Throws Error that names the file and
/// the JSON path for unknown fields, wrong types, missing specs, equal or unknown names, strengths
/// that do not lead away from clean, and a plan without any run.
StressPlan read_stress_plan(const std::filesystem::path& file,
                            const StressSelection& selection = {});

/// The spec of a scene at a point.
Json stress_spec(const StressScene& scene, const StressPoint& point, std::uint64_t seed);

/// `arguments` with the options of `more`: in the place of those of the same name, save --tune, or
/// at the end.
std::vector<std::string> merge_arguments(std::vector<std::string> arguments,
                                         const std::vector<std::string>& more);

}  // namespace photohull::chart

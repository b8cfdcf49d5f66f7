#include "lab/chart/plan.h"

#include <algorithm>
#include <cctype>

#include "core/error.h"
#include "lab/chart/json_fields.h"
#include "lab/chart/names.h"

namespace photohull::chart {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxResolution = 16384;

class PlanReader {
 public:
  explicit PlanReader(const fs::path& file)
      : plan_{.file = file}, json_(read_json(file)), root_(plan_.file, "", json_) {}

  Plan read() {
    root_.allow_only({"title", "scenes", "methods", "resolutions", "variants", "arguments",
                      "repeats", "time_limit_seconds", "threshold_percent", "keep", "mean_over",
                      "external", "comment"});
    plan_.title = root_.has("title") ? root_.text("title") : plan_.file.stem().string();
    if (root_.has("repeats")) plan_.repeats = root_.integer("repeats", 1, 99);
    if (root_.has("time_limit_seconds"))
      plan_.time_limit_seconds = root_.number("time_limit_seconds", 0.1, 1e6);
    if (root_.has("threshold_percent"))
      plan_.threshold_percent = root_.number("threshold_percent", 1e-6, 100);
    plan_.keep = root_.flag("keep", false);
    read_variants();
    for (const auto& [where, value] : root_.elements("scenes")) read_scene(where, *value, false);
    read_external();
    check();
    return std::move(plan_);
  }

 private:
  fs::path resolve(const std::string& text) const {
    return (plan_.file.parent_path() / text).lexically_normal();
  }

  void read_variants() {
    const std::vector<std::string> common = root_.texts("arguments");
    const std::vector<int> resolutions = root_.integers("resolutions", 1, kMaxResolution);
    for (const std::string& method : root_.texts("methods"))
      add({method, {"--method", method}, resolutions}, common, "methods");
    for (const auto& [where, value] : root_.elements("variants")) {
      const Fields fields(plan_.file, where, *value);
      fields.allow_only({"name", "arguments", "resolutions", "comment"});
      Variant v{fields.text("name"), fields.texts("arguments"), resolutions};
      if (fields.has("resolutions"))
        v.resolutions = fields.integers("resolutions", 1, kMaxResolution);
      add(std::move(v), common, where + ".name");
    }
    // The program says these itself.
    for (const Variant& v : plan_.variants)
      for (const std::string& a : v.arguments)
        for (const std::string own : {"--out", "--json", "--help"})
          if (a == own || a.starts_with(own + "="))
            root_.fail("variants", v.name + ": the argument " + own + " is set by the chart");
  }

  void add(Variant v, const std::vector<std::string>& common, const std::string& where) {
    if (const auto fault = label_fault(v.name)) root_.fail(where, *fault);
    v.arguments.insert(v.arguments.begin(), common.begin(), common.end());
    std::sort(v.resolutions.begin(), v.resolutions.end());
    v.resolutions.erase(std::unique(v.resolutions.begin(), v.resolutions.end()),
                        v.resolutions.end());
    for (const Variant& other : plan_.variants)
      if (other.name == v.name) root_.fail(where, "the name '" + v.name + "' is taken already");
    plan_.variants.push_back(std::move(v));
  }

  void read_scene(const std::string& where, const Json& value, bool optional) {
    if (value.is_string()) return add_scene(where, value.get<std::string>(), "", optional);
    const Fields fields(plan_.file, where, value);
    fields.allow_only({"path", "specs", "scenes", "name", "optional", "comment"});
    optional = fields.flag("optional", optional);
    if (fields.has("path") + fields.has("specs") + fields.has("scenes") != 1)
      root_.fail(where, "expected exactly one of 'path', 'specs' (a folder) and 'scenes'");
    if (fields.has("name") && !fields.has("path"))
      root_.fail(where + ".name", "only a scene with a 'path' takes a name");
    if (fields.has("path"))
      return add_scene(where, fields.text("path"), fields.has("name") ? fields.text("name") : "",
                       optional);
    if (fields.has("specs")) return add_specs(fields, where, optional);
    for (const auto& [element, inner] : fields.elements("scenes"))
      read_scene(fields.path(element), *inner, optional);
  }

  /// All specs of a folder, by name.
  void add_specs(const Fields& fields, const std::string& where, bool optional) {
    const fs::path folder = resolve(fields.text("specs"));
    std::error_code status;
    if (!fs::is_directory(folder, status)) {
      if (!optional) root_.fail(where, "there is no folder " + folder.string());
      plan_.notes.push_back("left out: " + folder.string() + " (absent and optional)");
      return;
    }
    std::vector<fs::path> specs;
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.is_regular_file() && entry.path().extension() == ".json")
        specs.push_back(entry.path());
    std::sort(specs.begin(), specs.end());
    if (specs.empty()) {
      if (!optional) root_.fail(where, "no *.json in the folder " + folder.string());
      plan_.notes.push_back("left out: " + folder.string() + " (empty and optional)");
    }
    for (const fs::path& spec : specs) insert({spec.stem().string(), spec, true}, where);
  }

  void add_scene(const std::string& where, const std::string& text, std::string name,
                 bool optional) {
    if (text.empty()) root_.fail(where, "expected a path");
    PlanScene scene{std::move(name), resolve(text), text.ends_with(".json")};
    if (!scene.path.has_filename()) scene.path = scene.path.parent_path();
    if (scene.name.empty())
      scene.name = (scene.synthetic ? scene.path.stem() : scene.path.filename()).string();
    std::error_code status;
    const bool there = scene.synthetic ? fs::is_regular_file(scene.path, status)
                                       : fs::is_directory(scene.path, status);
    if (!there && !optional)
      root_.fail(where,
                 concat("there is no ", scene.synthetic ? "file " : "folder ", scene.path.string(),
                        "; mend the path or mark the scene \"optional\": true"));
    if (there)
      insert(std::move(scene), where);
    else
      plan_.notes.push_back("left out: " + scene.path.string() + " (absent and optional)");
  }

  void insert(PlanScene scene, const std::string& where) {
    if (const auto fault = file_name_fault(scene.name)) root_.fail(where, *fault);
    for (const PlanScene& other : plan_.scenes)
      if (other.name == scene.name)
        root_.fail(where, "the scene's name '" + scene.name +
                              "' is taken already; give it another \"name\"");
    if (!scene.synthetic && !fs::exists(scene.path / "gt.ply"))
      root_.fail(where, scene.path.string() + " has no gt.ply: a chart needs the true surface");
    plan_.scenes.push_back(std::move(scene));
  }

  void read_external() {
    for (const auto& [where, value] : root_.elements("external")) {
      ExternalSource source;
      if (value->is_string()) {
        source.path = resolve(value->get<std::string>());
      } else {
        const Fields fields(plan_.file, where, *value);
        fields.allow_only({"path", "optional", "comment"});
        source = {resolve(fields.text("path")), fields.flag("optional", false)};
      }
      std::error_code status;
      const bool there = fs::is_regular_file(source.path, status);
      if (!there && !source.optional) root_.fail(where, "there is no file " + source.path.string());
      if (there)
        plan_.external.push_back(source);
      else
        plan_.notes.push_back("left out: " + source.path.string() + " (absent and optional)");
    }
  }

  void check() {
    if (plan_.variants.empty())
      root_.fail("methods", "the plan has no runs: name 'methods' or 'variants'");
    if (plan_.scenes.empty())
      root_.fail("scenes", plan_.notes.empty() ? "the plan has no runs: name at least one scene"
                                               : "the plan has no runs: all its scenes are absent");
    plan_.mean_over = root_.texts("mean_over");
  }

  Plan plan_;
  Json json_;
  Fields root_;
};

}  // namespace

Plan read_plan(const fs::path& file) { return PlanReader(file).read(); }

}  // namespace photohull::chart

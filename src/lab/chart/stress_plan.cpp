#include "lab/chart/stress_plan.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.h"
#include "core/json_levels.h"
#include "core/nearest_name.h"
#include "lab/chart/names.h"

namespace photohull::chart {
namespace {

namespace fs = std::filesystem;

constexpr double kFar = 1e300;

/// The shortest text that reads back to the number.
std::string text_of(double number) {
  char text[64];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

/// {"a": {"b": value}} of "a.b".
Json nested(const std::string& path, const Json& value) {
  const std::size_t dot = path.find('.');
  if (dot == std::string::npos) return Json{{path, value}};
  return Json{{path.substr(0, dot), nested(path.substr(dot + 1), value)}};
}

bool is_whole(double number) { return number == std::floor(number) && std::abs(number) < 1e15; }

Json number_json(double number) {
  return is_whole(number) ? Json(std::int64_t(number)) : Json(number);
}

class StressPlanReader {
 public:
  StressPlanReader(const fs::path& file, const StressSelection& selection)
      : selection_(selection),
        plan_{.file = file},
        json_(read_json(file)),
        root_(plan_.file, "", json_) {}

  StressPlan read() {
    root_.allow_only({"title", "scenes", "spec", "seeds", "arguments", "variants", "axes",
                      "time_limit_seconds", "kept", "mark_percent", "comment"});
    plan_.title = root_.has("title") ? root_.text("title") : plan_.file.stem().string();
    if (root_.has("time_limit_seconds"))
      plan_.time_limit_seconds = root_.number("time_limit_seconds", 0.1, 1e6);
    if (root_.has("kept")) plan_.kept = root_.number("kept", 0.01, 1);
    if (root_.has("mark_percent")) plan_.mark_percent = root_.number("mark_percent", 1e-6, 100);
    read_seeds();
    read_scenes();
    read_variants();
    read_axes();
    return std::move(plan_);
  }

 private:
  void read_seeds() {
    if (root_.has("seeds")) {
      const auto seeds = root_.integers("seeds", 0, 1 << 30);
      plan_.seeds.assign(seeds.begin(), seeds.end());
      if (plan_.seeds.empty()) root_.fail("seeds", "name at least one seed");
    }
    if (!selection_.seeds.empty()) plan_.seeds = selection_.seeds;
    std::sort(plan_.seeds.begin(), plan_.seeds.end());
    plan_.seeds.erase(std::unique(plan_.seeds.begin(), plan_.seeds.end()), plan_.seeds.end());
  }

  /// An object to merge into specs; empty when the field is absent.
  static Json patch(const Fields& fields, const std::string& name) {
    if (!fields.has(name)) return Json::object();
    if (!fields.at(name).is_object()) fields.fail(name, "expected an object");
    return fields.at(name);
  }

  void read_scenes() {
    const Json common = patch(root_, "spec");
    for (const auto& [where, value] : root_.elements("scenes")) {
      const Fields fields(plan_.file, where, *value);
      fields.allow_only({"name", "path", "spec", "on_demand", "comment"});
      StressScene scene;
      scene.spec = Json::object();
      fs::path folder = plan_.file.parent_path();
      if (fields.has("path")) {
        const fs::path path = (folder / fields.text("path")).lexically_normal();
        scene.spec = read_json(path);
        folder = path.parent_path();
        if (!scene.spec.is_object()) fields.fail("path", path.string() + " is no spec");
      }
      scene.spec.merge_patch(common);
      scene.spec.merge_patch(patch(fields, "spec"));
      scene.name = fields.text("name");
      if (const auto fault = file_name_fault(scene.name)) fields.fail("name", *fault);
      scene.spec["name"] = scene.name;
      make_mesh_absolute(scene.spec, folder);
      scene.on_demand = fields.flag("on_demand", false);
      for (const StressScene& other : plan_.scenes)
        if (other.name == scene.name)
          fields.fail("name", "the name '" + scene.name + "' is taken already");
      plan_.scenes.push_back(std::move(scene));
    }
    if (plan_.scenes.empty()) root_.fail("scenes", "the plan has no runs: name at least one scene");
  }

  static void make_mesh_absolute(Json& spec, const fs::path& folder) {
    if (!spec.contains("geometry") || !spec["geometry"].is_object() ||
        !spec["geometry"].contains("mesh") || !spec["geometry"]["mesh"].is_string())
      return;
    Json& mesh = spec["geometry"]["mesh"];
    mesh = fs::absolute(folder / mesh.get<std::string>()).lexically_normal().string();
  }

  std::vector<std::string> arguments_of(const Fields& fields) const {
    const std::vector<std::string> words = fields.texts("arguments");
    for (const std::string& word : words)
      for (const std::string own : {"--out", "--json", "--help"})
        if (word == own || word.starts_with(own + "="))
          fields.fail("arguments", "the argument " + own + " is set by 'photohull stress'");
    return words;
  }

  void read_variants() {
    const std::vector<std::string> common = arguments_of(root_);
    for (const auto& [where, value] : root_.elements("variants")) {
      const Fields fields(plan_.file, where, *value);
      fields.allow_only({"name", "arguments", "on_demand", "comment"});
      StressVariant v{fields.text("name"), merge_arguments(common, arguments_of(fields)),
                      fields.flag("on_demand", false)};
      if (const auto fault = label_fault(v.name)) fields.fail("name", *fault);
      for (const StressVariant& other : plan_.variants)
        if (other.name == v.name) fields.fail("name", "the name '" + v.name + "' is taken already");
      plan_.variants.push_back(std::move(v));
    }
    if (plan_.variants.empty()) plan_.variants.push_back({"default", common, false});
  }

  /// Indices of what an axis names in `field`, or of all that are not on demand.
  template <typename T>
  std::vector<std::size_t> chosen(const Fields& fields, const std::string& field,
                                  const std::vector<T>& all) const {
    std::vector<std::size_t> indices;
    if (!fields.has(field)) {
      for (std::size_t i = 0; i < all.size(); ++i)
        if (!all[i].on_demand) indices.push_back(i);
      if (indices.empty()) fields.fail(field, "all are on demand, so name those that are meant");
      return indices;
    }
    std::vector<std::string> known;
    for (const T& one : all) known.push_back(one.name);
    for (const std::string& name : fields.texts(field))
      indices.push_back(index_of(fields, field, known, name));
    if (indices.empty()) fields.fail(field, "names none");
    return indices;
  }

  static std::size_t index_of(const Fields& fields, const std::string& field,
                              const std::vector<std::string>& known, const std::string& name) {
    const auto at = std::find(known.begin(), known.end(), name);
    if (at != known.end()) return std::size_t(at - known.begin());
    const auto near = nearest_name(name, known);
    fields.fail(field,
                "there is no '" + name + "'" + (near ? "; did you mean '" + *near + "'?" : ""));
  }

  void read_axes() {
    std::vector<std::string> names;
    for (const auto& [where, value] : root_.elements("axes")) {
      const Fields fields(plan_.file, where, *value);
      StressAxis axis = read_axis(fields);
      if (std::find(names.begin(), names.end(), axis.name) != names.end())
        fields.fail("name", "the name '" + axis.name + "' is taken already");
      names.push_back(axis.name);
      const auto& wanted = selection_.axes;
      if (wanted.empty() || std::find(wanted.begin(), wanted.end(), axis.name) != wanted.end())
        plan_.axes.push_back(std::move(axis));
    }
    if (names.empty()) root_.fail("axes", "the plan has no runs: name at least one axis");
    for (const std::string& name : selection_.axes)
      if (std::find(names.begin(), names.end(), name) == names.end()) {
        std::string known;
        for (const std::string& n : names) known += (known.empty() ? "" : ", ") + n;
        throw UsageError("--axes: " + plan_.file.string() + " has no axis '" + name + "'; it has " +
                         known);
      }
  }

  StressAxis read_axis(const Fields& fields) {
    fields.allow_only({"name", "title", "group", "unit", "log", "same_mesh", "spec", "fields",
                       "argument", "strengths", "points", "clean", "scenes", "variants", "marks",
                       "comment"});
    StressAxis axis;
    axis.name = fields.text("name");
    if (const auto fault = file_name_fault(axis.name)) fields.fail("name", *fault);
    axis.title = fields.has("title") ? fields.text("title") : axis.name;
    axis.group = fields.has("group") ? fields.text("group") : "all";
    if (const auto fault = file_name_fault(axis.group)) fields.fail("group", *fault);
    axis.unit = fields.has("unit") ? fields.text("unit") : "";
    axis.log = fields.flag("log", false);
    axis.same_mesh = fields.flag("same_mesh", false);
    axis.scenes = chosen(fields, "scenes", plan_.scenes);
    axis.variants = chosen(fields, "variants", plan_.variants);
    read_points(fields, axis);
    check_order(fields, axis);
    read_marks(fields, axis);
    return axis;
  }

  /// A point that sets the axis's fields or argument to a number.
  static StressPoint point_at(const Fields& fields, double strength) {
    StressPoint point{strength, text_of(strength)};
    for (const std::string& field : fields.texts("fields"))
      point.spec.merge_patch(nested(field, number_json(strength)));
    if (fields.has("argument")) point.arguments = {fields.text("argument"), text_of(strength)};
    return point;
  }

  void read_points(const Fields& fields, StressAxis& axis) {
    if (fields.has("strengths") == fields.has("points"))
      fields.fail("points", "expected either 'strengths' (numbers) or 'points' (objects)");
    const Json common = patch(fields, "spec");
    for (const std::string& field : fields.texts("fields"))
      if (std::count(field.begin(), field.end(), '.') >= kMostJsonLevels)
        fields.fail("fields", concat("more than ", kMostJsonLevels, " levels"));
    if (fields.has("strengths")) {
      if (!fields.has("fields") && !fields.has("argument"))
        fields.fail("fields", "'strengths' need 'fields' of the spec or an 'argument' to set");
      for (const auto& [where, value] : fields.elements("strengths")) {
        if (!value->is_number()) fields.fail(where, "expected a number");
        axis.points.push_back(point_at(fields, value->get<double>()));
      }
    }
    std::size_t numbered = 0;
    for (const auto& [where, value] : fields.elements("points")) {
      const Fields inner(plan_.file, fields.path(where), *value);
      axis.points.push_back(read_point(inner, double(axis.points.size() + 1)));
      numbered += inner.has("strength");
    }
    if (axis.points.empty()) fields.fail("points", "the axis has none");
    axis.kinds = fields.has("points") && numbered == 0;
    if (fields.has("points") && !axis.kinds && numbered != axis.points.size())
      fields.fail("points", "either all of them have a 'strength' or none");
    axis.clean = {0, axis.kinds ? "clean" : "0"};
    if (fields.has("clean") && fields.at("clean").is_object())
      axis.clean = read_point(Fields(plan_.file, fields.path("clean"), fields.at("clean")), 0);
    else if (fields.has("clean"))
      axis.clean = point_at(fields, fields.number("clean", -kFar, kFar));
    for (StressPoint* point : all_of(axis)) {
      Json merged = common;
      merged.merge_patch(point->spec);
      point->spec = merged;
    }
  }

  static std::vector<StressPoint*> all_of(StressAxis& axis) {
    std::vector<StressPoint*> all = {&axis.clean};
    for (StressPoint& point : axis.points) all.push_back(&point);
    return all;
  }

  StressPoint read_point(const Fields& fields, double number) const {
    fields.allow_only({"strength", "label", "spec", "arguments", "comment"});
    StressPoint point;
    point.strength = fields.has("strength") ? fields.number("strength", -kFar, kFar) : number;
    if (!fields.has("strength") && number > 0 && !fields.has("label"))
      fields.fail("label", "is missing: a point has a 'strength' or a 'label'");
    point.label = fields.has("label") ? fields.text("label") : text_of(point.strength);
    if (const auto fault = label_fault(point.label)) fields.fail("label", *fault);
    point.spec = patch(fields, "spec");
    point.arguments = arguments_of(fields);
    return point;
  }

  /// Strengths lead away from clean, so that there is one place where it breaks.
  static void check_order(const Fields& fields, const StressAxis& axis) {
    const char* field = fields.has("points") ? "points" : "strengths";
    std::vector<std::string> labels;
    for (const StressPoint& p : axis.points) {
      if (std::find(labels.begin(), labels.end(), p.label) != labels.end())
        fields.fail(field, "'" + p.label + "' is there twice");
      labels.push_back(p.label);
    }
    if (axis.kinds) return;
    double before = axis.clean.strength;
    const bool rises = axis.points.front().strength > before;
    for (const StressPoint& p : axis.points) {
      if (rises ? p.strength <= before : p.strength >= before)
        fields.fail(field,
                    concat("strengths must lead away from the clean one (", axis.clean.strength,
                           ") in steps of one sense; ", p.strength, " does not"));
      before = p.strength;
    }
    if (axis.log && std::min(axis.clean.strength, axis.points.back().strength) < 0)
      fields.fail("log", "strengths below 0 have no logarithm");
  }

  void read_marks(const Fields& fields, StressAxis& axis) {
    std::vector<std::string> labels;
    for (const StressPoint& p : axis.points) labels.push_back(p.label);
    std::vector<std::string> variants;
    for (const std::size_t v : axis.variants) variants.push_back(plan_.variants[v].name);
    for (const auto& [where, value] : fields.elements("marks")) {
      const Fields inner(plan_.file, fields.path(where), *value);
      inner.allow_only({"text", "at", "variant", "comment"});
      StressMark mark{inner.text("text"), 0, variants.front()};
      const Json& at = inner.at("at");
      mark.point = index_of(inner, "at", labels,
                            at.is_number() ? text_of(at.get<double>()) : inner.text("at"));
      if (inner.has("variant"))
        mark.variant = variants[index_of(inner, "variant", variants, inner.text("variant"))];
      axis.marks.push_back(std::move(mark));
    }
  }

  const StressSelection& selection_;
  StressPlan plan_;
  Json json_;
  Fields root_;
};

}  // namespace

StressPlan read_stress_plan(const fs::path& file, const StressSelection& selection) {
  return StressPlanReader(file, selection).read();
}

Json stress_spec(const StressScene& scene, const StressPoint& point, std::uint64_t seed) {
  Json spec = scene.spec;
  spec.merge_patch(point.spec);
  spec["seed"] = seed;
  return spec;
}

std::vector<std::string> merge_arguments(std::vector<std::string> arguments,
                                         const std::vector<std::string>& more) {
  const auto is_option = [](const std::string& word) { return word.starts_with("--"); };
  for (auto at = more.begin(); at != more.end();) {
    const auto end = std::find_if(at + 1, more.end(), is_option);
    auto from = is_option(*at) && *at != "--tune"
                    ? std::find(arguments.begin(), arguments.end(), *at)
                    : arguments.end();
    if (from != arguments.end())
      from = arguments.erase(from, std::find_if(from + 1, arguments.end(), is_option));
    arguments.insert(from, at, end);
    at = end;
  }
  return arguments;
}

}  // namespace photohull::chart

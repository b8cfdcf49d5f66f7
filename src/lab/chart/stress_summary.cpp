#include "lab/chart/stress_summary.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.h"
#include "lab/chart/statistics.h"

namespace photohull::chart {
namespace {

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

std::optional<double> number_or_none(const Fields& fields, const std::string& name) {
  if (!fields.has(name) || fields.at(name).is_null()) return std::nullopt;
  return fields.number(name, -1e300, 1e300);
}

std::string text_or_empty(const Fields& fields, const std::string& name) {
  const Json& value = fields.at(name);
  if (!value.is_string()) fields.fail(name, "expected a text");
  return value.get<std::string>();
}

/// The samples of a variant on an axis.
class Curve {
 public:
  Curve(const StressPlan& plan, std::size_t axis, const std::string& variant,
        const std::vector<StressSample>& samples)
      : plan_(plan), axis_(plan.axes[axis]) {
    curve_.axis = axis;
    curve_.variant = variant;
    for (const StressSample& s : samples)
      if (s.axis == axis_.name && s.variant == variant) own_.push_back(&s);
  }

  StressCurve make() {
    add_point(axis_.clean, true);
    for (const StressPoint& p : axis_.points) add_point(p, false);
    add_scenes();
    if (axis_.kinds) {
      for (const CurvePoint& p : curve_.points)
        if (p.kept025 && *p.kept025 < plan_.kept) curve_.broken_kinds.push_back(p.label);
    } else {
      curve_.break025 = break_of([](const CurvePoint& p) { return p.kept025; });
      curve_.break05 = break_of([](const CurvePoint& p) { return p.kept05; });
    }
    return std::move(curve_);
  }

 private:
  const StressSample* clean_of(const StressSample& sample) const {
    for (const StressSample* s : own_)
      if (s->clean && s->scene == sample.scene && s->seed == sample.seed) return s;
    return nullptr;
  }

  static std::optional<double> ratio(const std::optional<double>& value,
                                     const std::optional<double>& clean) {
    if (!value || !clean || !(*clean > 0)) return std::nullopt;
    return *value / *clean;
  }

  bool is_at(const StressSample& s, const StressPoint& point, bool clean) const {
    return clean ? s.clean : !s.clean && s.label == point.label;
  }

  void add_point(const StressPoint& point, bool clean) {
    CurvePoint p;
    p.strength = point.strength;
    p.label = point.label;
    Mean f025, f05, confidence, within, kept025, kept05;
    for (const StressSample* s : own_) {
      if (!is_at(*s, point, clean)) continue;
      ++p.samples;
      p.failed += s->figures.failed;
      f025.add(s->figures.f025), f05.add(s->figures.f05);
      confidence.add(s->figures.confidence), within.add(s->figures.within);
      const StressSample* base = clean_of(*s);
      if (!base) continue;
      p.other_mesh += s->mesh_hash != base->mesh_hash;
      const auto kept = ratio(s->figures.f025, base->figures.f025);
      kept025.add(kept);
      kept05.add(ratio(s->figures.f05, base->figures.f05));
      if (kept && (!p.worst025 || *kept < *p.worst025)) {
        p.worst025 = kept;
        p.worst_scene = s->scene;
      }
    }
    p.f025 = f025.value(), p.f05 = f05.value();
    p.confidence = confidence.value(), p.within = within.value();
    p.kept025 = kept025.value(), p.kept05 = kept05.value();
    curve_.points.push_back(std::move(p));
  }

  void add_scenes() {
    std::vector<std::string> scenes;
    for (const StressSample* s : own_)
      if (std::find(scenes.begin(), scenes.end(), s->scene) == scenes.end())
        scenes.push_back(s->scene);
    for (const std::string& scene : scenes) {
      const auto value = [&](const StressPoint& point, bool clean) {
        Mean mean;
        for (const StressSample* s : own_)
          if (s->scene == scene && is_at(*s, point, clean)) mean.add(s->figures.f025);
        return mean.value();
      };
      std::vector<std::optional<double>> values = {value(axis_.clean, true)};
      for (const StressPoint& p : axis_.points) values.push_back(value(p, false));
      curve_.scenes.emplace_back(scene, std::move(values));
    }
  }

  template <typename Value>
  std::optional<double> break_of(const Value& value) const {
    std::vector<CurveSample> samples;
    for (const CurvePoint& p : curve_.points)
      if (const auto y = value(p)) samples.push_back({p.strength, *y});
    return breakdown_point(samples, plan_.kept, axis_.log);
  }

  const StressPlan& plan_;
  const StressAxis& axis_;
  std::vector<const StressSample*> own_;
  StressCurve curve_;
};

MarkResult judge_mark(const StressPlan& plan, const StressAxis& axis, const StressMark& mark,
                      const StressCurve& curve) {
  MarkResult r{mark.text, axis.name, mark.variant, axis.points[mark.point].label,
               {},        {},        "",           false};
  bool complete = true;
  // Kinds have no order: only the one that is named counts.
  for (std::size_t i = axis.kinds ? mark.point : 0; i <= mark.point; ++i) {
    const CurvePoint& p = curve.points[i + 1];
    if (!p.kept025 || !p.worst025) {
      complete = false;
      continue;
    }
    if (!r.mean || *p.kept025 < *r.mean) r.mean = p.kept025;
    if (!r.worst || *p.worst025 < *r.worst) {
      r.worst = p.worst025;
      r.worst_at = p.worst_scene + " at " + p.label;
    }
  }
  r.pass = complete && r.worst && *r.worst >= plan.kept;
  return r;
}

}  // namespace

Json StressSample::to_json() const {
  return {{"axis", axis},
          {"label", label},
          {"clean", clean},
          {"strength", strength},
          {"scene", scene},
          {"seed", seed},
          {"variant", variant},
          {"run", run},
          {"exit_code", exit_code},
          {"message", message},
          {"mesh_hash", mesh_hash},
          {"cpu_seconds", cpu_seconds},
          {"f025", or_null(figures.f025)},
          {"f05", or_null(figures.f05)},
          {"confidence", or_null(figures.confidence)},
          {"within_a_voxel", or_null(figures.within)},
          {"verdict", figures.verdict},
          {"report", report}};
}

StressSample StressSample::from_json(const std::filesystem::path& file, const std::string& where,
                                     const Json& json) {
  const Fields fields(file, where, json);
  StressSample s;
  s.axis = fields.text("axis");
  s.label = fields.text("label");
  s.clean = fields.flag("clean", false);
  s.strength = fields.number("strength", -1e300, 1e300);
  s.scene = fields.text("scene");
  s.seed = std::uint64_t(fields.number("seed", 0, 1e15));
  s.variant = fields.text("variant");
  s.run = fields.text("run");
  s.exit_code = fields.integer("exit_code", -1, 255);
  s.message = text_or_empty(fields, "message");
  s.mesh_hash = text_or_empty(fields, "mesh_hash");
  s.cpu_seconds = fields.number("cpu_seconds", 0, 1e12);
  s.figures.f025 = number_or_none(fields, "f025");
  s.figures.f05 = number_or_none(fields, "f05");
  s.figures.confidence = number_or_none(fields, "confidence");
  s.figures.within = number_or_none(fields, "within_a_voxel");
  s.figures.verdict = text_or_empty(fields, "verdict");
  s.figures.failed = s.exit_code != 0;
  s.report = fields.at("report");
  return s;
}

std::optional<double> breakdown_point(const std::vector<CurveSample>& curve, double least,
                                      bool log) {
  for (std::size_t i = 0; i < curve.size(); ++i) {
    if (curve[i].y >= least) continue;
    if (i == 0) return curve[0].x;
    const CurveSample a = curve[i - 1], b = curve[i];
    const double share = (a.y - least) / (a.y - b.y);
    if (log && a.x > 0 && b.x > 0) return a.x * std::pow(b.x / a.x, share);
    return a.x + share * (b.x - a.x);
  }
  return std::nullopt;
}

VerdictTable judge_verdicts(const std::vector<StressSample>& samples) {
  VerdictTable table;
  std::set<std::string> counted;
  for (const StressSample& s : samples) {
    if (!s.figures.f05 || !counted.insert(s.run).second) continue;
    const std::string& verdict = s.figures.verdict;
    table.any = table.any || !verdict.empty();
    const std::size_t row = *s.figures.f05 < 0.8 ? 0 : *s.figures.f05 <= 0.95 ? 1 : 2;
    const std::size_t column = s.figures.failed || verdict == "failed" ? 2
                               : verdict == "doubtful"                 ? 1
                               : verdict == "good"                     ? 0
                                                                       : 3;
    ++table.counts[row][column];
  }
  const auto called = [&](std::size_t row) -> std::optional<double> {
    const auto& c = table.counts[row];
    const int all = c[0] + c[1] + c[2] + c[3];
    return all ? std::optional(double(c[1] + c[2]) / all) : std::nullopt;
  };
  table.bad_called = called(0);
  table.good_called = called(2);
  return table;
}

StressSummary summarize(const StressPlan& plan, std::vector<StressSample> samples,
                        std::vector<StressSample> earlier) {
  StressSummary summary;
  const std::size_t own = samples.size();
  std::move(earlier.begin(), earlier.end(), std::back_inserter(samples));
  for (std::size_t a = 0; a < plan.axes.size(); ++a) {
    const StressAxis& axis = plan.axes[a];
    std::vector<std::string> variants;
    for (const std::size_t v : axis.variants) variants.push_back(plan.variants[v].name);
    // Those of an earlier run come along under names of their own.
    for (const StressSample& s : samples)
      if (s.axis == axis.name &&
          std::find(variants.begin(), variants.end(), s.variant) == variants.end())
        variants.push_back(s.variant);
    for (const std::string& variant : variants)
      summary.curves.push_back(Curve(plan, a, variant, samples).make());
    for (const StressMark& mark : axis.marks)
      for (const StressCurve& curve : summary.curves)
        if (curve.axis == a && curve.variant == mark.variant)
          summary.marks.push_back(judge_mark(plan, axis, mark, curve));
  }
  samples.resize(own);
  summary.verdicts = judge_verdicts(samples);
  summary.samples = std::move(samples);
  return summary;
}

}  // namespace photohull::chart

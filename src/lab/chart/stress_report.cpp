#include "lab/chart/stress_report.h"

#include <algorithm>
#include <cstdio>
#include <set>

#include "core/atomic_file.h"
#include "core/error.h"
#include "lab/chart/chart_files.h"
#include "lab/chart/page.h"
#include "lab/chart/stress_charts.h"
#include "lab/chart/style.h"

namespace photohull::chart {
namespace {

namespace fs = std::filesystem;

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

/// "93.2", in percent; "-" for none.
std::string percents(const std::optional<double>& share) {
  if (!share) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", 100 * *share);
  return text;
}

Json point_json(const CurvePoint& p) {
  return {{"strength", p.strength},
          {"label", p.label},
          {"f025", or_null(p.f025)},
          {"f05", or_null(p.f05)},
          {"kept025", or_null(p.kept025)},
          {"kept05", or_null(p.kept05)},
          {"worst025", or_null(p.worst025)},
          {"worst_scene", p.worst_scene},
          {"confidence", or_null(p.confidence)},
          {"within_a_voxel", or_null(p.within)},
          {"samples", p.samples},
          {"failed", p.failed},
          {"other_mesh", p.other_mesh}};
}

Json curve_json(const StressPlan& plan, const StressCurve& curve) {
  const StressAxis& axis = plan.axes[curve.axis];
  Json j = {{"axis", axis.name},
            {"group", axis.group},
            {"unit", axis.unit},
            {"variant", curve.variant},
            {"breakdown_f025", or_null(curve.break025)},
            {"breakdown_f05", or_null(curve.break05)},
            {"broken_kinds", curve.broken_kinds},
            {"points", Json::array()},
            {"scenes_f025", Json::object()}};
  for (const CurvePoint& p : curve.points) j["points"].push_back(point_json(p));
  for (const auto& [scene, values] : curve.scenes) {
    Json list = Json::array();
    for (const auto& value : values) list.push_back(or_null(value));
    j["scenes_f025"][scene] = list;
  }
  return j;
}

Json mark_json(const MarkResult& m) {
  return {{"text", m.text},         {"axis", m.axis},          {"variant", m.variant},
          {"up_to", m.label},       {"mean", or_null(m.mean)}, {"worst", or_null(m.worst)},
          {"worst_at", m.worst_at}, {"pass", m.pass}};
}

Json verdict_json(const VerdictTable& table) {
  Json j = {{"measured", table.any},
            {"bad_called", or_null(table.bad_called)},
            {"good_called", or_null(table.good_called)}};
  const char* rows[] = {"below_80", "80_to_95", "above_95"};
  const char* columns[] = {"good", "doubtful", "failed", "none"};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 4; ++c) j["counts"][rows[r]][columns[c]] = table.counts[r][c];
  return j;
}

/// Text of a cell of a Markdown table.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out;
}

std::string marks_table(const StressPlan& plan, const StressSummary& summary) {
  std::string md =
      "| promise | settings | kept, mean over scenes (%) | kept, worst scene (%) | where | |\n"
      "|---|---|---|---|---|---|\n";
  for (const MarkResult& m : summary.marks)
    md += "| " + cell(m.text) + " | " + cell(m.variant) + " | " + percents(m.mean) + " | " +
          percents(m.worst) + " | " + cell(m.worst_at) + " | " +
          (m.pass    ? "pass"
           : m.worst ? concat("short by ", percents(plan.kept - *m.worst))
                     : std::string("not measured")) +
          " |\n";
  return md;
}

std::string break_text(const StressAxis& axis, const StressCurve& curve,
                       const std::optional<double>& at) {
  if (axis.kinds) {
    std::string names;
    for (const std::string& kind : curve.broken_kinds) names += (names.empty() ? "" : ", ") + kind;
    return names.empty() ? "none" : names;
  }
  if (at) return shown(*at);
  const auto last = std::find_if(curve.points.rbegin(), curve.points.rend(),
                                 [](const CurvePoint& p) { return p.samples > 0; });
  return last == curve.points.rend() ? "-" : "not to " + last->label;
}

std::string breakdown_table(const StressPlan& plan, const StressSummary& summary) {
  std::string md =
      "| degradation | unit | settings | clean F 0.25 % | breaks at, F 0.25 % | breaks at, F 0.5 "
      "% |\n|---|---|---|---|---|---|\n";
  for (const StressCurve& curve : summary.curves) {
    const StressAxis& axis = plan.axes[curve.axis];
    md += "| " + cell(axis.title) + " | " + cell(axis.unit) + " | " + cell(curve.variant) + " | " +
          percents(curve.points.front().f025) + " | " +
          cell(break_text(axis, curve, curve.break025)) + " | " +
          (axis.kinds ? "" : break_text(axis, curve, curve.break05)) + " |\n";
  }
  return md;
}

std::string curves_table(const StressPlan& plan, const StressSummary& summary) {
  std::string md =
      "| degradation | settings | strength | F 0.25 % | F 0.5 % | kept (%) | worst kept (%) | "
      "confidence (%) | within a voxel (%) | failed |\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const StressCurve& curve : summary.curves) {
    const StressAxis& axis = plan.axes[curve.axis];
    for (const CurvePoint& p : curve.points)
      md += "| " + cell(axis.title) + " | " + cell(curve.variant) + " | " + cell(p.label) + " | " +
            percents(p.f025) + " | " + percents(p.f05) + " | " + percents(p.kept025) + " | " +
            percents(p.worst025) + " | " + percents(p.confidence) + " | " + percents(p.within) +
            " | " + (p.failed ? concat(p.failed, " of ", p.samples) : std::string()) + " |\n";
  }
  return md;
}

std::string same_mesh_table(const StressPlan& plan, const StressSummary& summary) {
  std::string md;
  for (const StressCurve& curve : summary.curves) {
    const StressAxis& axis = plan.axes[curve.axis];
    if (!axis.same_mesh) continue;
    for (std::size_t i = 1; i < curve.points.size(); ++i) {
      const CurvePoint& p = curve.points[i];
      md += "| " + cell(axis.title) + " " + cell(p.label) + " | " + cell(curve.variant) + " | " +
            concat(p.samples - p.other_mesh, " of ", p.samples) + " |\n";
    }
  }
  if (md.empty()) return md;
  return "\n## Equal bytes\n\n| runs | settings | meshes equal to the clean one's "
         "|\n|---|---|---|\n" +
         md;
}

std::string verdict_table(const VerdictTable& table) {
  if (!table.any) return "No report has a verdict.\n";
  std::string md = "| F at 0.5 % | good | doubtful | failed | none |\n|---|---|---|---|---|\n";
  const char* rows[] = {"below 80 %", "80 to 95 %", "above 95 %"};
  for (std::size_t r = 0; r < 3; ++r) {
    md += std::string("| ") + rows[r];
    for (const int count : table.counts[r]) md += concat(" | ", count);
    md += " |\n";
  }
  md += "\nCalled doubtful or failed: " + percents(table.bad_called) +
        " % of the results below 80 %, " + percents(table.good_called) +
        " % of those above 95 %.\n";
  return md;
}

std::string page_table(const StressSummary& summary) {
  std::string html =
      "<table "
      "id=results><thead><tr><th>degradation<th>scene<th>settings<th>strength<th>seed<th>CPU "
      "s<th>F 0.25 %<th>F 0.5 %<th>confidence %<th>within a voxel "
      "%<th>verdict</tr></thead><tbody>\n";
  const auto number = [](const std::string& text) { return "<td class=n>" + text + "</td>"; };
  for (const StressSample& s : summary.samples) {
    html +=
        std::string("<tr") + (s.figures.failed ? " class=failed" : "") + "><td>" + escaped(s.axis) +
        "</td><td>" + escaped(s.scene) + "</td><td>" + escaped(s.variant) + "</td>" +
        number(escaped(s.label)) + number(std::to_string(s.seed)) + number(shown(s.cpu_seconds)) +
        number(percents(s.figures.f025)) + number(percents(s.figures.f05)) +
        number(percents(s.figures.confidence)) + number(percents(s.figures.within)) + "<td>" +
        escaped(s.figures.verdict + (s.message.empty() ? "" : " " + s.message)) + "</td></tr>\n";
  }
  return html + "</tbody></table>";
}

}  // namespace

void write_stress_results(const fs::path& file, const StressPlan& plan,
                          const StressSummary& summary) {
  Json j = {{"layout", StressRecord::kLayout},
            {"photohull", PHOTOHULL_VERSION},
            {"title", plan.title},
            {"kept", plan.kept},
            {"marks", Json::array()},
            {"verdicts", verdict_json(summary.verdicts)},
            {"curves", Json::array()},
            {"samples", Json::array()}};
  for (const MarkResult& m : summary.marks) j["marks"].push_back(mark_json(m));
  for (const StressCurve& c : summary.curves) j["curves"].push_back(curve_json(plan, c));
  for (const StressSample& s : summary.samples) j["samples"].push_back(s.to_json());
  write_atomically(file, j.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::vector<StressSample> read_stress_results(const fs::path& file) {
  std::error_code status;
  if (!fs::is_regular_file(file, status))
    throw Error(concat(file.string(), ": there are no results of 'photohull stress'"));
  const Json json = read_json(file);
  const Fields fields(file, "", json);
  if (fields.at("layout") != StressRecord::kLayout)
    fields.fail("layout", "written by another version of photohull; run it again");
  if (!fields.has("samples"))
    fields.fail("samples", "is missing: no results of 'photohull stress'");
  std::vector<StressSample> samples;
  for (const auto& [where, value] : fields.elements("samples"))
    samples.push_back(StressSample::from_json(file, where, *value));
  return samples;
}

std::string stress_markdown(const StressPlan& plan, const StressSummary& summary) {
  std::set<std::string> runs;
  for (const StressSample& s : summary.samples) runs.insert(s.run);
  std::string md = "# " + plan.title + "\n\n" + concat(runs.size(), " reconstructions.\n");
  if (!summary.marks.empty())
    md += "\n## Promises\n\n" +
          concat("F-score at 0.25 % kept at ", 100 * plan.kept,
                 " % or more of the clean one, at every strength up to the one named.\n\n") +
          marks_table(plan, summary);
  md += "\n## Where it breaks\n\n" +
        concat("The strength at which the mean F-score over scenes falls below ", 100 * plan.kept,
               " % of the clean one, interpolated.\n\n") +
        breakdown_table(plan, summary) + same_mesh_table(plan, summary) + "\n## Verdicts\n\n" +
        verdict_table(summary.verdicts) + "\n## All points\n\nMeans over scenes and seeds.\n\n" +
        curves_table(plan, summary);
  return md;
}

std::vector<std::string> write_stress_page(const fs::path& folder, const StressPlan& plan,
                                           const StressSummary& summary, Progress& progress) {
  const std::vector<Chart> charts = stress_charts(plan, summary);
  std::vector<std::string> files = write_chart_files(charts, folder, progress);
  files.insert(files.begin(), {"index.html", "summary.md"});
  write_atomically(folder / "summary.md", stress_markdown(plan, summary));
  write_atomically(
      folder / "index.html",
      make_page({plan.title,
                 {"Thick lines: means over scenes; thin ones: single scenes. F: F-score over the "
                  "surface that cameras see, in percent of the diagonal. Confidence: what mesh.ply "
                  "promises; dotted: the share of its vertices that are within a voxel."},
                 charts,
                 "Group",
                 "Red rows ended with an error or by the program's own verdict.",
                 page_table(summary)}));
  remove_stale_charts(folder, files);
  return files;
}

}  // namespace photohull::chart

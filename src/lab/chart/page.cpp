#include "lab/chart/page.h"

#include <algorithm>
#include <set>

#include "core/html_template.h"
#include "lab/chart/embedded_files.h"
#include "page/style.h"

namespace photohull::chart {
namespace {

Json charts_json(const std::vector<Chart>& charts) {
  Json array = Json::array();
  for (const Chart& c : charts)
    array.push_back({{"id", c.id},
                     {"group", c.group},
                     {"width", c.width},
                     {"height", c.height},
                     {"option", c.option}});
  return array;
}

std::set<double> thresholds_of(const std::vector<Outcome>& outcomes) {
  std::set<double> thresholds;
  for (const Outcome& o : outcomes)
    for (const auto& [t, f] : o.figures.f_percent) {
      const bool known = std::any_of(thresholds.begin(), thresholds.end(),
                                     [&, t = t](double k) { return std::abs(k - t) < 1e-6 * t; });
      if (!known) thresholds.insert(t);
    }
  return thresholds;
}

template <typename Value>
std::string cell(const Value& value) {
  return "<td class=n>" + shown(value) + "</td>";
}

/// Labels on the front of their scene.
std::set<std::pair<std::string, std::string>> front_labels(const std::vector<Outcome>& outcomes,
                                                           double threshold_percent) {
  std::set<std::string> scenes;
  for (const Outcome& o : outcomes) scenes.insert(o.scene);
  std::set<std::pair<std::string, std::string>> labels;
  for (const std::string& scene : scenes) {
    std::vector<Outcome> of_scene;
    std::copy_if(outcomes.begin(), outcomes.end(), std::back_inserter(of_scene),
                 [&](const Outcome& o) { return o.scene == scene; });
    for (const std::size_t i : front_of(of_scene, threshold_percent))
      labels.emplace(scene, of_scene[i].label());
  }
  return labels;
}

std::string table(const std::vector<Outcome>& outcomes, double threshold_percent) {
  const std::set<double> thresholds = thresholds_of(outcomes);
  const auto front = front_labels(outcomes, threshold_percent);
  std::string html =
      "<table id=results><thead><tr><th>scene<th>run<th>status<th class=n>CPU s<th class=n>wall "
      "s<th "
      "class=n>MiB";
  for (const double t : thresholds) html += "<th class=n>F " + shown(t) + " %";
  html +=
      "<th class=n>90 % within %<th class=n>complete %<th class=n>triangles</tr></thead><tbody>\n";
  for (const Outcome& o : outcomes) {
    const bool first = front.contains({o.scene, o.label()});
    html += std::string("<tr") +
            (o.failed ? " class=failed"
             : first  ? " class=front"
                      : "") +
            "><td>" + escaped(o.scene) + "</td><td>" + escaped(o.label()) +
            (o.external ? " <i>(external)</i>" : "") + "</td><td>" +
            (o.failed ? "FAILED: " + escaped(o.failure)
             : first  ? "on the front"
                      : "ok") +
            "</td>" + cell(o.cpu_seconds) + cell(o.wall_seconds) + cell(o.peak_mb);
    for (const double t : thresholds) html += cell(o.figures.f_at(t));
    html += cell(o.figures.accuracy_percent) + cell(o.figures.completeness_percent) +
            "<td class=n>" + (o.figures.triangles ? std::to_string(*o.figures.triangles) : "-") +
            "</td></tr>\n";
  }
  return html + "</tbody></table>";
}

}  // namespace

std::string make_page(const PageParts& parts) {
  std::string note_items;
  for (const std::string& note : parts.notes) note_items += "<li>" + escaped(note) + "</li>\n";
  return fill_template(page_template(), [&](std::string_view name) -> std::string {
    if (name == "STYLE") return std::string(page::base_style());
    if (name == "TITLE") return escaped(parts.title);
    if (name == "NOTES") return note_items;
    if (name == "ECHARTS") return std::string(echarts_js());
    if (name == "CHARTS")
      return inside_script(
          charts_json(parts.charts).dump(-1, ' ', false, Json::error_handler_t::replace));
    if (name == "CHOICE") return escaped(parts.choice);
    if (name == "CAPTION") return parts.caption;
    if (name == "TABLE") return parts.table;
    return "";
  });
}

std::string make_page(const std::string& title, const std::vector<std::string>& notes,
                      const std::vector<Chart>& charts, const std::vector<Outcome>& outcomes,
                      double threshold_percent) {
  return make_page(
      {title, notes, charts, "Scene",
       "Distances and thresholds are in percent of the diagonal of the truth's bounding "
       "box. Bold rows are on the Pareto front of their scene.",
       table(outcomes, threshold_percent)});
}

}  // namespace photohull::chart

#include "page/make_page.h"

#include <nlohmann/json.hpp>
#include <string_view>

#include "core/error.h"
#include "core/html_template.h"
#include "page/embedded_files.h"
#include "page/pack.h"
#include "page/style.h"

namespace photohull::page {
namespace {

using nlohmann::ordered_json;

ordered_json view_json(const ShownView& view) {
  const Intrinsics& k = view.camera.intrinsics;
  const glm::dmat3& r = view.camera.cam_from_world.rotation;
  const glm::dvec3 c = view.camera.center();
  ordered_json rows = ordered_json::array();
  for (int row = 0; row < 3; ++row) rows.push_back({r[0][row], r[1][row], r[2][row]});
  return {{"name", view.name},         {"size", {k.width, k.height}},
          {"focal", {k.fx, k.fy}},     {"skew", k.skew},
          {"principal", {k.cx, k.cy}}, {"rotation", rows},
          {"centre", {c.x, c.y, c.z}}, {"jpeg", base64(view.jpeg)}};
}

/// What the page needs of the report: not the digests of the files that were read, nor the work of
/// each kernel, of which there is much, nor the cameras, which it has beside their photographs.
ordered_json shown_report(const std::string& report) {
  ordered_json json = ordered_json::parse(report, nullptr, false);
  if (!json.is_object()) throw Error("the report that a page is to be made of is not JSON");
  json.erase("inputs");
  json.erase("device_work");
  json.erase("cameras");
  return json;
}

std::string data_json(const std::string& report, const std::string& command, const Shown& shown) {
  ordered_json data = {{"report", shown_report(report)},
                       {"command", command},
                       {"model", ordered_json::parse(shown.model.table)},
                       {"first_view", shown.first_view},
                       {"up", {shown.up.x, shown.up.y, shown.up.z}},
                       {"views", ordered_json::array()}};
  for (const ShownView& view : shown.views) data["views"].push_back(view_json(view));
  return inside_script(data.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
}

std::string packed_text(std::string_view text) {
  return packed({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace

std::string make_page(const std::string& report, const std::string& command, const Shown& shown) {
  return fill_template(page_template(), [&](std::string_view name) -> std::string {
    if (name == "STYLE") return std::string(base_style()) + std::string(page_style());
    if (name == "DATA") return data_json(report, command, shown);
    if (name == "MODEL") return shown.model.packed;
    if (name == "TEXTURE") return base64(shown.texture);
    if (name == "THREE") return packed_text(three_js());
    if (name == "SCRIPT") return std::string(page_script());
    return "";
  });
}

}  // namespace photohull::page

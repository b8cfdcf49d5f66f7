#include "page/make_batch_page.h"

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/html_template.h"
#include "page/embedded_files.h"
#include "page/style.h"

namespace photohull::page {
namespace {

using nlohmann::ordered_json;

std::string batch_json(std::span<const ShownPiece> pieces) {
  ordered_json list = ordered_json::array();
  for (const ShownPiece& piece : pieces) {
    ordered_json figures = ordered_json::parse(piece.figures, nullptr, false);
    if (!figures.is_object()) throw Error("the figures that a page is to be made of are not JSON");
    figures["preview"] = piece.preview;
    figures["page"] = piece.page;
    list.push_back(std::move(figures));
  }
  const ordered_json data = {{"photohull", PHOTOHULL_VERSION}, {"pieces", list}};
  return inside_script(data.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
}

}  // namespace

std::string make_batch_page(std::span<const ShownPiece> pieces) {
  return fill_template(batch_template(), [&](std::string_view name) -> std::string {
    if (name == "STYLE") return std::string(base_style()) + std::string(batch_style());
    if (name == "DATA") return batch_json(pieces);
    if (name == "SCRIPT") return std::string(batch_script());
    return "";
  });
}

}  // namespace photohull::page

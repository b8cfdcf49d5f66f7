#include "batch/plan.h"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "core/error.h"
#include "core/json_levels.h"
#include "core/option_word.h"

namespace photohull::batch {

using nlohmann::json;

std::string new_plan_id() {
  std::random_device random;
  return concat(std::uint32_t(random()), '-', std::uint32_t(random()), '-',
                std::uint32_t(random()));
}

std::string to_json(const Plan& plan) {
  json pieces = json::array();
  for (const Piece& piece : plan.pieces)
    pieces.push_back({{"name", piece.name}, {"words", piece.words}, {"joins", piece.joins}});
  return json{{"id", plan.id},
              {"folder", plan.folder.string()},
              {"sequence", plan.sequence},
              {"tiles", plan.tiles},
              {"pieces", pieces}}
             .dump(1, ' ', false, json::error_handler_t::replace) +
         "\n";
}

Plan plan_from_json(const std::string& text, const std::filesystem::path& file) {
  try {
    const json all = json::parse(text, json_level_guard(file.string()));
    Plan plan;
    all.at("id").get_to(plan.id);
    plan.folder = all.at("folder").get<std::string>();
    all.at("sequence").get_to(plan.sequence);
    plan.tiles = all.value("tiles", 0);
    for (const json& one : all.at("pieces")) {
      Piece piece;
      one.at("name").get_to(piece.name);
      one.at("words").get_to(piece.words);
      piece.joins = one.value("joins", piece.joins);
      piece.from = concat(file.string(), ", piece ", piece.name);
      plan.pieces.push_back(std::move(piece));
    }
    check_pieces(plan.pieces);
    return plan;
  } catch (const json::exception& e) {
    throw Error(concat(file.string(), ": not a plan of pieces (", e.what(), "); make it anew"));
  }
}

std::vector<std::size_t> chosen_pieces(const std::string& text, std::size_t count) {
  const auto range = parse_frames(text);
  if (!range || range->first < 1 || std::size_t(range->last) > count)
    throw UsageError(concat(option_word("pieces", text),
                            ": give the numbers of pieces between 1 and ", count,
                            ", such as 3 or 3-7"));
  std::vector<std::size_t> chosen(std::size_t(range->last - range->first + 1));
  std::iota(chosen.begin(), chosen.end(), std::size_t(range->first - 1));
  return chosen;
}

}  // namespace photohull::batch

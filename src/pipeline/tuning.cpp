#include "pipeline/tuning.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <map>
#include <string_view>
#include <variant>

#include "core/error.h"

namespace photohull::pipeline {
namespace {

constexpr const char *kMissing = "missing.", *kStems = "stems.";

using Field = std::variant<int*, double*, bool*>;

void assign(const std::vector<std::string>& assignments,
            const std::map<std::string, Field>& fields) {
  for (const std::string& text : assignments) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    const auto field = fields.find(name);
    if (field == fields.end()) {
      std::string known;
      for (const auto& [other, unused] : fields) known += (known.empty() ? "" : ", ") + other;
      throw UsageError(
          concat("--tune ", text, ": this method has no '", name, "'; it has ", known));
    }
    const std::string number = equals == std::string::npos ? "" : text.substr(equals + 1);
    char* end = nullptr;
    const double value = std::strtod(number.c_str(), &end);
    if (number.empty() || *end != 0 || !std::isfinite(value) || std::abs(value) > 1e6)
      throw UsageError(concat("--tune ", text, ": expected NAME=NUMBER"));
    const auto set = [&](auto* target) {
      *target = static_cast<std::decay_t<decltype(*target)>>(value);
      if (double(*target) != value)
        throw UsageError(concat("--tune ", text, ": expected a whole number, 0 or 1 for a switch"));
    };
    std::visit(set, field->second);
  }
}

/// Of the assignments, those whose names begin with one of the prefixes that all methods share, or
/// the others.
std::vector<std::string> with_prefix(const std::vector<std::string>& assignments,
                                     std::string_view prefix) {
  std::vector<std::string> out;
  std::copy_if(assignments.begin(), assignments.end(), std::back_inserter(out),
               [&](const std::string& text) { return text.starts_with(prefix); });
  return out;
}

std::vector<std::string> of_method(std::vector<std::string> assignments) {
  std::erase_if(assignments, [](const std::string& text) {
    return text.starts_with(kMissing) || text.starts_with(kStems);
  });
  return assignments;
}

void require(bool holds, const char* rule) {
  if (!holds) throw UsageError(concat("--tune: ", rule));
}

}  // namespace

void tune(const std::vector<std::string>& assignments, carving::MissingOptions& o) {
  assign(with_prefix(assignments, kMissing), {{"missing.most_missing", &o.most_missing},
                                              {"missing.least_support", &o.least_support},
                                              {"missing.support_share", &o.support_share},
                                              {"missing.full_miss", &o.full_miss}});
  require(o.most_missing >= 0 && o.most_missing <= 0.5,
          "missing.most_missing must lie in [0, 0.5]");
  require(o.least_support >= 1, "missing.least_support must be 1 or more");
  require(o.support_share >= 0 && o.support_share <= 1, "missing.support_share must lie in [0, 1]");
  require(o.full_miss >= 0.5 && o.full_miss <= 100,
          "missing.full_miss must lie in [0.5, 100] pixels");
}

void tune(const std::vector<std::string>& assignments, carving::StemOptions& o) {
  assign(with_prefix(assignments, kStems),
         {{"stems.least_share", &o.least_share}, {"stems.least_views", &o.least_views}});
  require(o.least_share >= 0, "stems.least_share must be 0 or more");
  require(o.least_views >= 1, "stems.least_views must be 1 or more");
}

void tune(const std::vector<std::string>& assignments, carving::PhotoOptions& o) {
  assign(of_method(assignments), {{"keep_score", &o.keep_score},
                                  {"better_by", &o.better_by},
                                  {"min_views", &o.min_views},
                                  {"min_texture", &o.min_texture},
                                  {"noise_sigma", &o.noise_sigma},
                                  {"supersample", &o.supersample},
                                  {"front_face", &o.front_face},
                                  {"depth_bias", &o.depth_bias},
                                  {"max_path", &o.max_path},
                                  {"max_rounds", &o.max_rounds}});
}

void tune(const std::vector<std::string>& assignments, refine::RefineOptions& o,
          SharpenOptions& sharpen) {
  assign(of_method(assignments), {{"levels", &o.levels},
                                  {"coarse_iterations", &o.coarse_iterations},
                                  {"middle_iterations", &o.middle_iterations},
                                  {"fine_iterations", &o.fine_iterations},
                                  {"coarse_offsets", &o.coarse_offsets},
                                  {"fine_offsets", &o.fine_offsets},
                                  {"step", &o.step},
                                  {"aggregations", &o.aggregations},
                                  {"voting", &o.voting},
                                  {"vote.ray_spacing", &o.vote.ray_spacing},
                                  {"vote.again_spacing", &o.vote.again_spacing},
                                  {"vote.last_spacing", &o.vote.last_spacing},
                                  {"vote.again_score", &o.vote.again_score},
                                  {"vote.again_weight", &o.vote.again_weight},
                                  {"vote.freeing_weight", &o.vote.freeing_weight},
                                  {"vote.tap_spacing", &o.vote.tap_spacing},
                                  {"vote.best_pairs", &o.vote.best_pairs},
                                  {"vote.least_score", &o.vote.least_score},
                                  {"vote.distinct_by", &o.vote.distinct_by},
                                  {"vote.band", &o.vote.band},
                                  {"vote.rounds", &o.vote.rounds},
                                  {"vote.last_rounds", &o.vote.last_rounds},
                                  {"vote.bare_reach", &o.vote.bare_reach},
                                  {"open.rounds", &o.open.rounds},
                                  {"open.tiles", &o.open.tiles},
                                  {"open.reach", &o.open.reach},
                                  {"open.last_reach", &o.open.last_reach},
                                  {"label.evidence", &o.label.evidence},
                                  {"label.unknown", &o.label.unknown},
                                  {"label.iterations", &o.label.iterations},
                                  {"vote.least_weight", &o.vote.least_weight},
                                  {"closing", &o.closing},
                                  {"close.iterations", &o.close.iterations},
                                  {"close.rings", &o.close.rings},
                                  {"close.belt", &o.close.belt},
                                  {"close.thickness", &o.close.thickness},
                                  {"restore.least_views", &o.restore.least_views},
                                  {"restore.least_inside", &o.restore.least_inside},
                                  {"restore.most_before", &o.restore.most_before},
                                  {"rims.reach", &o.rims.reach},
                                  {"rims.weight", &o.rims.weight},
                                  {"rims.told", &o.rims.told},
                                  {"unproven.least_weight", &o.unproven.least_weight},
                                  {"unproven.least_depth", &o.unproven.least_depth},
                                  {"thin.depth", &o.thin.depth},
                                  {"thin.reach", &o.thin.reach},
                                  {"match.least_spacing", &o.match.least_spacing},
                                  {"match.pixel_spacing", &o.match.pixel_spacing},
                                  {"match.most_bend", &o.match.most_bend},
                                  {"match.best_pairs", &o.match.best_pairs},
                                  {"match.shift", &o.match.shift},
                                  {"match.depth_bias", &o.match.depth_bias},
                                  {"match.least_cosine", &o.match.least_cosine},
                                  {"match.nearest_angle", &o.match.nearest_angle},
                                  {"match.farthest_angle", &o.match.farthest_angle},
                                  {"match.sparse_angle", &o.match.sparse_angle},
                                  {"match.duplicate_angle", &o.match.duplicate_angle},
                                  {"peak.least_score", &o.peak.least_score},
                                  {"peak.sure_score", &o.peak.sure_score},
                                  {"peak.distinct_by", &o.peak.distinct_by},
                                  {"seat.passes", &o.seat.passes},
                                  {"seat.reach", &o.seat.reach},
                                  {"seat.unsure", &o.seat.unsure},
                                  {"seat.margin", &o.seat.margin},
                                  {"settle.least_pixels", &o.settle.least_pixels},
                                  {"settle.least_texture", &o.settle.least_texture},
                                  {"settle.flat", &o.settle.flat},
                                  {"look.least_score", &o.look.least_score},
                                  {"look.least_weight", &o.look.least_weight},
                                  {"look.margin", &o.look.margin},
                                  {"look.least_lines", &o.look.least_lines},
                                  {"peak.thick", &o.peak.thick},
                                  {"photometric", &o.photometric},
                                  {"fit.steps", &o.fit.steps},
                                  {"fit.noise", &o.fit.noise},
                                  {"fit.hold_out", &o.fit.hold_out},
                                  {"fit.least_spacing", &o.fit.least_spacing},
                                  {"fit.pixel_spacing", &o.fit.pixel_spacing},
                                  {"fit.least_score", &o.fit.least_score},
                                  {"fit.sure_score", &o.fit.sure_score},
                                  {"fit.slope", &o.fit.slope},
                                  {"fit.largest_offset", &o.fit.largest_offset},
                                  {"fit.largest_step", &o.fit.largest_step},
                                  {"fit.most_bend", &o.fit.most_bend},
                                  {"fit.sure", &o.fit.sure},
                                  {"fit.most_weight", &o.fit.most_weight},
                                  {"fit.membrane", &o.fit.membrane},
                                  {"fit.fairing", &o.fit.fairing},
                                  {"regularize.membrane", &o.regularize.membrane},
                                  {"regularize.fairing", &o.regularize.fairing},
                                  {"regularize.robust", &o.regularize.robust},
                                  {"regularize.reweightings", &o.regularize.reweightings},
                                  {"regularize.iterations", &o.regularize.iterations},
                                  {"sharpen", &sharpen.on},
                                  {"sharpen.bend", &sharpen.bend},
                                  {"sharpen.reach", &sharpen.reach},
                                  {"sharpen.most_turn", &sharpen.most_turn},
                                  {"sharpen.distinct", &sharpen.distinct},
                                  {"sharpen.rounding", &sharpen.rounding},
                                  {"sharpen.share", &sharpen.share},
                                  {"sharpen.shortest", &sharpen.shortest}});
}

}  // namespace photohull::pipeline

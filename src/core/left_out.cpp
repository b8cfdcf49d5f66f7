#include "core/left_out.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/option_word.h"

namespace photohull {
namespace {

constexpr std::size_t kNamed = 3;   // photographs, in a sentence
constexpr double kRounding = 1e-9;  // of shares

using Reason = LeftOutView::Reason;
constexpr Reason kReasons[] = {Reason::kMissing, Reason::kUnreadable, Reason::kSize};

const char* verb(Reason reason, bool one) {
  switch (reason) {
    case Reason::kMissing:
      return one ? " was not found" : " were not found";
    case Reason::kUnreadable:
      return " cannot be read";
    case Reason::kSize:
      return one ? " does not have its camera's shape" : " do not have their cameras' shape";
  }
  return "";
}

/// "a.png, b.png, c.png and 5 more; looked in x/", or with each one's own reason in place of where
/// was looked: that is the same for all.
std::string names_of(const std::vector<const LeftOutView*>& views) {
  std::string text;
  const bool missing = views.front()->reason == Reason::kMissing;
  for (std::size_t i = 0; i < std::min(views.size(), kNamed); ++i)
    text += (i ? ", " : "") + views[i]->name + (missing ? "" : ": " + views[i]->detail);
  if (views.size() > kNamed) text += concat(" and ", views.size() - kNamed, " more");
  return missing ? text + "; " + views.front()->detail : text;
}

}  // namespace

void keep_views(Scene& scene, const std::vector<bool>& keep) {
  PHOTOHULL_CHECK_OP(keep.size(), ==, scene.views.size());
  std::vector<int> now(keep.size(), -1);
  std::vector<SourceView> views;
  for (std::size_t i = 0; i < keep.size(); ++i) {
    if (!keep[i]) continue;
    now[i] = int(views.size());
    views.push_back(std::move(scene.views[i]));
  }
  scene.views = std::move(views);
  for (SceneTrack& track : scene.tracks) {
    for (SceneTrack::Observation& o : track.observations) o.view = now[std::size_t(o.view)];
    std::erase_if(track.observations, [](const auto& o) { return o.view < 0; });
  }
  std::erase_if(scene.tracks, [](const SceneTrack& t) { return t.observations.size() < 2; });
}

std::vector<std::string> note_left_out(Scene& scene, const std::vector<LeftOutView>& unusable,
                                       bool strict) {
  if (unusable.empty()) return {};
  const std::size_t remaining = scene.views.size(), all = remaining + unusable.size();
  scene.usable_share *= double(remaining) / double(all);
  const bool enough =
      remaining >= kFewestRemaining && scene.usable_share >= kLeastRemainingShare - kRounding;
  std::vector<std::string> warnings;
  std::string problem;
  for (const Reason reason : kReasons) {
    std::vector<const LeftOutView*> these;
    for (const LeftOutView& view : unusable)
      if (view.reason == reason) these.push_back(&view);
    if (these.empty()) continue;
    const bool one = these.size() == 1;
    const std::string said = concat(these.size(), " of ", all, " photographs", verb(reason, one));
    warnings.push_back(concat(said, one ? " and is" : " and are", " left out (", names_of(these),
                              "); ", option_word("strict"), " refuses"));
    problem += concat(problem.empty() ? "" : ", ", said, " (", names_of(these), ")");
  }
  if (strict || !enough)
    throw Error(concat(unusable.front().where, ": ", problem, "; ",
                       strict ? concat(option_word("strict"), " asks for all of them")
                              : "at least two of three, and three views, must remain",
                       ": put them right, or choose others with ", option_word("views")));
  scene.left_out.insert(scene.left_out.end(), unusable.begin(), unusable.end());
  return warnings;
}

}  // namespace photohull

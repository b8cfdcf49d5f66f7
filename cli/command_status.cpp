#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "batch_arguments.h"
#include "batch_overview.h"
#include "cli/front/command_table.h"
#include "commands.h"

namespace photohull::cli {
namespace {

using nlohmann::json;

struct StatusArguments {
  std::string job;
  bool json = false;
};

/// The pieces by what is known of them.
struct Status {
  std::map<std::string, std::vector<std::string>> made;     ///< by verdicts
  std::vector<std::pair<std::string, std::string>> failed;  ///< names and messages
  std::vector<std::string> at_work, waiting;
  double cpu_seconds = 0;  ///< of all that was made or tried
};

Status status_of(const batch::Store& store, const batch::Plan& plan) {
  Status status;
  for (const batch::Piece& piece : plan.pieces) {
    const std::optional<batch::Outcome> outcome = store.outcome(piece.name);
    if (outcome) status.cpu_seconds += outcome->cpu_seconds;
    if (!store.hold(piece.name)) {
      status.at_work.push_back(piece.name);
    } else if (!outcome) {
      status.waiting.push_back(piece.name);
    } else if (outcome->has_result()) {
      status.made[outcome->verdict].push_back(piece.name);
    } else {
      status.failed.emplace_back(piece.name, outcome->message);
    }
  }
  return status;
}

void print_names(const char* what, const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 5;
  std::printf("%-14s %zu", what, names.size());
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i)
    std::printf("%s%s", i == 0 ? ": " : ", ", names[i].c_str());
  std::printf("%s\n", names.size() > kMost ? ", ..." : "");
}

void print_text(const Status& status) {
  for (const auto& [verdict, names] : status.made) print_names(("made, " + verdict).c_str(), names);
  for (const auto& [name, message] : status.failed)
    std::printf("%-14s %s: %s\n", "no result", name.c_str(), message.c_str());
  print_names("at work", status.at_work);
  print_names("waiting", status.waiting);
}

void print_json(const Status& status, std::size_t count) {
  json failed = json::object();
  for (const auto& [name, message] : status.failed) failed[name] = message;
  const bool complete = status.at_work.empty() && status.waiting.empty() && failed.empty();
  const json all = {{"pieces", count},
                    {"made", status.made},
                    {"failed", failed},
                    {"at_work", status.at_work},
                    {"waiting", status.waiting},
                    {"complete", complete},
                    {"cpu_seconds", status.cpu_seconds}};
  std::printf("%s\n", all.dump(-1, ' ', false, json::error_handler_t::replace).c_str());
}

void run_status(const StatusArguments& a) {
  const batch::Store store = batch::Store::existing(a.job);
  const batch::Plan plan = store.plan();
  const Status status = status_of(store, plan);
  if (a.json)
    print_json(status, plan.pieces.size());
  else
    print_text(status);
}

void merge(const std::string& job) {
  const batch::Store store = batch::Store::existing(job);
  std::vector<std::string> names;
  for (const batch::Piece& piece : store.plan().pieces) names.push_back(piece.name);
  merge_batch(names, store);
}

}  // namespace

void add_status(CLI::App& app) {
  auto a = std::make_shared<StatusArguments>();
  CLI::App* c = add_command(app, "status");
  add_plan_folder(*c, a->job);
  c->add_flag("--json", a->json, "print one line of JSON");
  c->footer(
      "Tells which scenes of a plan are made, which have no result, which some process is at work "
      "at, and which wait. Disturbs nobody.\n\n"
      "Examples:\n"
      "  photohull status /shared/plants\n"
      "  photohull status /shared/plants --json");
  c->callback([a] { run_status(*a); });
}

void add_merge(CLI::App& app) {
  auto job = std::make_shared<std::string>();
  CLI::App* c = add_command(app, "merge");
  add_plan_folder(*c, *job);
  c->footer(
      "Writes the table batch.csv and the page index.html of all that was made, and sums it up. "
      "Ends with an error where "
      "scenes are not made yet or have no result.\n\n"
      "Examples:\n"
      "  photohull merge /shared/plants");
  c->callback([job] { merge(*job); });
}

}  // namespace photohull::cli

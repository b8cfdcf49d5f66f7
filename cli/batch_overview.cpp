#include "batch_overview.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>

#include "core/error.h"
#include "page/make_batch_page.h"

namespace photohull::cli {

void fill(std::vector<batch::Row>& rows, const batch::Store& store) {
  for (batch::Row& row : rows)
    if (!row.outcome) row.outcome = store.outcome(row.name);
}

void write_overview(const std::vector<batch::Row>& rows, const batch::Store& store) {
  store.write_table(table_of(rows));
  std::vector<page::ShownPiece> pieces;
  for (const batch::Row& row : rows) {
    std::error_code ignored;
    const std::filesystem::path folder = store.results(row.name);
    pieces.push_back({to_json(row.name, row.outcome),
                      std::filesystem::exists(folder / "preview.png", ignored),
                      std::filesystem::exists(folder / "report.html", ignored)});
  }
  store.write_page(page::make_batch_page(pieces));
}

int tell(const std::vector<batch::Row>& rows, const std::string& more, bool json,
         const batch::Store& store) {
  std::map<std::string, int> verdicts;
  int without = 0, waiting = 0;
  const batch::Row* first = nullptr;
  for (const batch::Row& row : rows) {
    if (!row.outcome) {
      ++waiting;
    } else if (row.outcome->has_result()) {
      ++verdicts[row.outcome->verdict];
    } else {
      if (without++ == 0) first = &row;
    }
  }
  if (!json) {
    std::printf("%zu %s%s\n", rows.size(), rows.size() == 1 ? "scene" : "scenes", more.c_str());
    for (const auto& [verdict, count] : verdicts)
      std::printf("verdict %s: %d\n", verdict.c_str(), count);
    if (waiting > 0) std::printf("not made yet: %d\n", waiting);
    std::printf("  %s\n  %s\n", store.table().c_str(), store.page().c_str());
  }
  const int failed = verdicts.contains("failed") ? verdicts.at("failed") : 0;
  if (without > 0)
    throw Error(concat(without, " of ", rows.size(), " scenes have no result, the first is ",
                       first->name, ": ", first->outcome->message));
  if (failed > 0)
    throw Error(concat(failed, " of ", rows.size(), " results failed their own checks; see ",
                       store.table().string()),
                ErrorKind::kDoubted);
  return waiting;
}

void merge_batch(const std::vector<std::string>& names, const batch::Store& store) {
  std::vector<batch::Row> rows;
  for (const std::string& name : names) rows.push_back({name, {}});
  fill(rows, store);
  write_overview(rows, store);
  const int waiting = tell(rows, "", false, store);
  if (waiting == 0) return;
  const auto first =
      std::find_if(rows.begin(), rows.end(), [](const auto& row) { return !row.outcome; });
  throw Error(concat(waiting, " of ", rows.size(), " scenes are not made yet, the first is ",
                     first->name, "; 'photohull run ", store.folder().string(), "' makes them"));
}

}  // namespace photohull::cli

#include "io/select_views.h"

#include <fnmatch.h>

#include <algorithm>
#include <optional>

#include "core/error.h"
#include "io/text_file.h"

namespace photohull::io {
namespace {

bool is_digits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

std::size_t view_index(std::string_view digits, std::string_view item, std::size_t count,
                       const std::string& option) {
  const auto index = parse_integer(digits);
  if (!index || *index >= std::int64_t(count))
    throw UsageError(concat(option, ": '", item, "' is out of range, the scene has views 0 to ",
                            std::int64_t(count) - 1));
  return std::size_t(*index);
}

/// Marks the views of an index "7" or a range "3-9"; false when the item is neither.
bool mark_indices(std::string_view item, std::vector<bool>& kept, const std::string& option) {
  const std::size_t dash = item.find('-');
  const bool range = dash != std::string_view::npos;
  const std::string_view low = item.substr(0, dash);
  const std::string_view high = range ? item.substr(dash + 1) : low;
  if (!is_digits(low) || !is_digits(high)) return false;
  const std::size_t first = view_index(low, item, kept.size(), option);
  const std::size_t last = view_index(high, item, kept.size(), option);
  if (first > last)
    throw UsageError(
        concat(option, ": the range '", item, "' runs backwards; write ", last, "-", first));
  std::fill(kept.begin() + std::ptrdiff_t(first), kept.begin() + std::ptrdiff_t(last) + 1, true);
  return true;
}

bool mark_names(const std::string& item, const std::vector<std::string>& names,
                std::vector<bool>& kept) {
  bool any = false;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == item || fnmatch(item.c_str(), names[i].c_str(), 0) == 0) {
      kept[i] = true;
      any = true;
    }
  return any;
}

}  // namespace

std::vector<std::size_t> select_views(const std::string& selection,
                                      const std::vector<std::string>& names,
                                      const std::string& option) {
  std::vector<bool> kept(names.size(), selection.empty());
  for (std::size_t begin = 0; begin <= selection.size() && !selection.empty();) {
    const std::size_t end = std::min(selection.find(',', begin), selection.size());
    const std::string item(trimmed(std::string_view(selection).substr(begin, end - begin)));
    if (item.empty())
      throw UsageError(concat(option, ": '", selection, "' has an empty item; write e.g. 0-10,15"));
    // A view may be called "12": its name wins over the index.
    const bool named = std::find(names.begin(), names.end(), item) != names.end();
    if (named || !mark_indices(item, kept, option))
      if (!mark_names(item, names, kept))
        throw UsageError(concat(option, ": '", item, "' is no view of the scene and matches none"));
    begin = end + 1;
  }
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < kept.size(); ++i)
    if (kept[i]) indices.push_back(i);
  return indices;
}

}  // namespace photohull::io

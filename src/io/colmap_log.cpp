#include "io/colmap_log.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace photohull::io {
namespace {

/// What stands after `label` in a line; empty where it is not there.
std::string after(std::string_view line, std::string_view label) {
  const std::size_t at = line.find(label);
  if (at == std::string_view::npos) return {};
  std::string_view rest = line.substr(at + label.size());
  while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
  return std::string(rest);
}

}  // namespace

void ColmapLog::hear(std::string_view piece) {
  text_ += piece;
  for (const char c : piece) {
    if (c == '\n' || c == '\r')
      end_line();
    else
      line_ += c;
  }
}

void ColmapLog::end_line() {
  if (!line_.empty()) take(line_);
  line_.clear();
}

void ColmapLog::end_command() {
  end_line();
  image_.clear();
}

void ColmapLog::take(std::string_view line) {
  int i = 0, n = 0, j = 0, m = 0;
  if (const std::string file = after(line, "Processed file ["); !file.empty()) {
    image_.clear();
    if (std::sscanf(file.c_str(), "%d/%d", &i, &n) == 2 && n > 0)
      progress_.update(double(i) / double(n));
  } else if (const std::string block = after(line, "Matching block ["); !block.empty()) {
    if (std::sscanf(block.c_str(), "%d/%d, %d/%d", &i, &n, &j, &m) == 4 && n > 0 && m > 0)
      progress_.update((double(i - 1) * m + j - 1) / (double(n) * m));
  } else if (const std::string one = after(line, "Matching image ["); !one.empty()) {
    if (std::sscanf(one.c_str(), "%d/%d", &i, &n) == 2 && n > 0)
      progress_.update(double(i - 1) / double(n));
  } else if (const std::string placed = after(line, "Registering image #"); !placed.empty()) {
    if (std::sscanf(placed.c_str(), "%d (%d)", &i, &n) == 2 && photographs_ > 0)
      progress_.update(double(n) / double(photographs_));
  } else if (const std::string name = after(line, "  Name: "); !name.empty()) {
    image_ = name;
    images_.emplace(image_, Heard());
  } else if (const std::string count = after(line, "  Features: "); !count.empty()) {
    if (!image_.empty()) images_[image_].features = std::atoi(count.c_str());
  } else if (const std::string problem = after(line, "ERROR: "); !problem.empty()) {
    if (!image_.empty()) images_[image_].problem = problem;
  }
}

std::string ColmapLog::last_lines(std::size_t begin) const {
  constexpr std::size_t kLines = 3, kMost = 400;
  std::vector<std::string> lines(1);
  for (const char c : text_.substr(std::min(begin, text_.size()))) {
    if (c == '\n') {
      if (!lines.back().empty()) lines.emplace_back();
    } else if (c != ' ' || (!lines.back().empty() && lines.back().back() != ' ')) {
      lines.back() += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
  }
  if (lines.back().empty()) lines.pop_back();
  std::string last;
  for (std::size_t i = lines.size() - std::min(kLines, lines.size()); i < lines.size(); ++i)
    last += (last.empty() ? "" : " / ") + lines[i];
  if (last.size() > kMost) last.erase(0, last.size() - kMost);
  return last;
}

}  // namespace photohull::io

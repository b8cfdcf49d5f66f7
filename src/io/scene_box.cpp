#include "io/scene_box.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "io/text_file.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

/// "(x y z)" and nothing else.
std::optional<glm::dvec3> parse_corner(std::string_view line) {
  if (line.size() < 2 || line.front() != '(' || line.back() != ')') return std::nullopt;
  const auto fields = split_fields(line.substr(1, line.size() - 2));
  if (fields.size() != 3) return std::nullopt;
  glm::dvec3 corner;
  for (int axis = 0; axis < 3; ++axis) {
    const auto value = parse_double(fields[axis]);
    if (!value) return std::nullopt;
    corner[axis] = *value;
  }
  return corner;
}

}  // namespace

void check_box(const Box& box, const std::string& source) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(box.min[axis]) || !std::isfinite(box.max[axis]))
      throw Error(concat(source, ": the box holds a value that is not a finite number"));
    if (!(box.min[axis] < box.max[axis]))
      throw Error(concat(source, ": the box runs from ", box.min[axis], " to ", box.max[axis],
                         " along ", "xyz"[axis], ", but the first corner must be the smaller one"));
  }
}

std::string sort_corners(Box& box) {
  std::string axes;
  for (int axis = 0; axis < 3; ++axis)
    if (box.max[axis] < box.min[axis]) {
      std::swap(box.min[axis], box.max[axis]);
      axes += concat(axes.empty() ? "" : ", ", "xyz"[axis]);
    }
  return axes;
}

std::optional<Box> read_bbox_file(const fs::path& folder) {
  const fs::path file = folder / "bbox.txt";
  if (!is_file(file)) return std::nullopt;
  std::vector<double> values;
  for (Lines lines(file); lines.next_content();)
    for (const std::string_view field : split_fields(lines.text(), 7))
      values.push_back(lines.number(field, "a box coordinate"));
  if (values.size() != 6)
    throw Error(concat(file.string(), ": ", values.size(),
                       " numbers found, but the box needs 6: min x y z, then max x y z"));
  const Box box{{values[0], values[1], values[2]}, {values[3], values[4], values[5]}};
  check_box(box, file.string());
  return box;
}

std::optional<Box> read_readme_box(const fs::path& folder) {
  const fs::path file = folder / "README.txt";
  if (!is_file(file)) return std::nullopt;
  Box box;
  int corners = -1;  // read since the words; -1: not seen, or followed by something else
  for (Lines lines(file); corners < 2 && lines.next();) {
    if (lines.text().empty()) continue;
    if (lines.text().find("bounding box") != std::string_view::npos) {
      corners = 0;
    } else if (corners >= 0) {
      const auto corner = parse_corner(lines.text());
      if (corner) (corners == 0 ? box.min : box.max) = *corner;
      corners = corner ? corners + 1 : -1;
    }
  }
  if (corners < 2) return std::nullopt;
  check_box(box, file.string());
  return box;
}

std::optional<Box> box_of_points(const std::vector<glm::dvec3>& points) {
  constexpr std::size_t kFewest = 10;
  if (points.size() < kFewest) return std::nullopt;
  Box box;
  std::vector<double> values(points.size());
  const auto percentile = [&](double share) {
    const auto nth =
        values.begin() + std::ptrdiff_t(std::lround(share * double(values.size() - 1)));
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
  };
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(points.begin(), points.end(), values.begin(),
                   [axis](const glm::dvec3& p) { return p[axis]; });
    box.min[axis] = percentile(0.02);
    box.max[axis] = percentile(0.98);
  }
  const double diagonal = box.diagonal();
  if (!(diagonal > 0) || !std::isfinite(diagonal)) return std::nullopt;
  const glm::dvec3 margin = glm::max(0.1 * box.size(), glm::dvec3(0.01 * diagonal));
  return Box{box.min - margin, box.max + margin};
}

}  // namespace photohull::io

#include "pose.h"

#include <pybind11/stl.h>

#include <filesystem>

#include "core/error.h"
#include "io/board_images.h"
#include "io/photo_lens.h"
#include "job.h"
#include "options.h"
#include "pose/pose_colmap.h"
#include "pose/pose_sheet.h"

namespace photohull::python {
namespace py = pybind11;
namespace {

// Of the stages, as the command line counts them.
constexpr double kOnSheet = 1, kByColmap = 1.2;

void describe_pose(Described& to, pose::PoseJob& job) {
  describe(to, job.sheet);
  describe(to, job.focal);
}

py::list options_of_pose() {
  pose::PoseJob job;
  Described described;
  describe_pose(described, job);
  return option_list(described);
}

std::vector<std::string> photographs_of(const py::object& given) {
  std::vector<std::string> paths;
  if (py::isinstance<py::list>(given) || py::isinstance<py::tuple>(given))
    for (const py::handle one : given) paths.push_back(path_of(py::cast<py::object>(one)));
  else
    paths.push_back(path_of(given));
  if (paths.empty()) throw UsageError("photographs: give at least one, or a folder of them");
  return paths;
}

void refuse_options_of_sheet(const py::dict& given) {
  pose::PoseJob job;
  Described of_sheet;
  describe(of_sheet, job.sheet);
  for (const auto& [key, value] : given)
    if (const std::string name = key.cast<std::string>(); of_sheet.find(name) && !value.is_none())
      throw UsageError(concat(name, ": it says something of a printed sheet: give its board, too"));
}

/// pose.json. `board` and `masks` may be None.
std::string find_poses(const py::object& photographs, const py::object& out,
                       const py::object& board, bool make_masks, const py::object& masks,
                       bool ordered, const py::dict& given, const py::object& progress) {
  pose::PoseJob job;
  Described described;
  describe_pose(described, job);
  set_options(described, given, "photohull.pose");
  const std::vector<std::string> paths = photographs_of(photographs);
  const std::string folder = path_of(out);
  if (folder.empty()) throw UsageError("out: it is empty: give a folder for the scene");
  job.out = std::filesystem::absolute(folder).lexically_normal();
  if (!board.is_none()) job.board = path_of(board);
  if (!masks.is_none()) job.masks = path_of(masks);
  const bool on_sheet = !board.is_none();
  if (on_sheet && !job.masks.empty())
    throw UsageError("masks: they are for photographs without a board, whose masks are made");
  if (on_sheet && ordered) throw UsageError("ordered: it is for photographs without a board");
  if (!on_sheet) refuse_options_of_sheet(given);
  job.make_masks = make_masks;
  job.ordered = ordered;
  std::string report;
  run_job(progress, on_sheet ? kOnSheet : kByColmap, [&](Progress& to) {
    for (const std::filesystem::path& file : io::list_unreadable(paths))
      to.warn(concat(file.string(),
                     " is left out, for files of its kind cannot be read: convert it to JPEG, or "
                     "set the camera to write JPEG"));
    job.images = io::list_images(paths);
    job.names = pose::names_of(job.images);
    std::vector<std::string> warnings;
    if (on_sheet) {
      pose::SheetPose posed = pose::pose_on_sheet(job, to);
      report = std::move(posed.report), warnings = std::move(posed.result.warnings);
    } else {
      pose::ColmapPose posed = pose::pose_with_colmap(job, to);
      report = std::move(posed.report), warnings = std::move(posed.warnings);
    }
    for (const std::string& warning : warnings) to.warn(warning);
  });
  return report;
}

}  // namespace

void bind_pose(py::module_& module) {
  module.def("pose", find_poses);
  module.def("pose_options", options_of_pose);
}

}  // namespace photohull::python

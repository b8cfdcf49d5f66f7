#include "pose.h"

#include <pybind11/stl.h>

#include <filesystem>
#include <optional>

#include "core/error.h"
#include "io/board_images.h"
#include "io/photo_lens.h"
#include "job.h"
#include "options.h"
#include "pose/pose_colmap.h"
#include "pose/pose_sheet.h"
#include "pose_arrays.h"

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

void refuse_options_of_sheet(const py::dict& given) {
  pose::PoseJob job;
  Described of_sheet;
  describe(of_sheet, job.sheet);
  for (const auto& [key, value] : given)
    if (const std::string name = key.cast<std::string>(); of_sheet.find(name) && !value.is_none())
      throw UsageError(concat(name, ": it says something of a printed sheet: give its board, too"));
}

/// The photographs, and with COLMAP their masks.
struct Pictures {
  std::vector<std::string> paths;  ///< none where there are arrays
  std::optional<PosedArrays> arrays;
  std::string masks;  ///< a folder
};

Pictures pictures_of(const py::object& photographs, const py::object& masks, bool on_sheet) {
  if (on_sheet && !masks.is_none())
    throw UsageError("masks: they are for photographs without a board, whose masks are made");
  Pictures pictures;
  if (are_arrays(photographs)) {
    pictures.arrays.emplace(photographs, masks);
    return pictures;
  }
  if (py::isinstance<py::list>(photographs) || py::isinstance<py::tuple>(photographs))
    for (const py::handle one : photographs)
      pictures.paths.push_back(path_of(py::cast<py::object>(one)));
  else
    pictures.paths.push_back(path_of(photographs));
  if (pictures.paths.empty())
    throw UsageError("photographs: give at least one, or a folder of them");
  if (!masks.is_none() && !is_path(masks))
    throw UsageError("masks: expected a folder, as the photographs are files");
  if (!masks.is_none()) pictures.masks = path_of(masks);
  return pictures;
}

void take(const Pictures& pictures, pose::PoseJob& job, Progress& progress) {
  job.masks = pictures.masks;
  if (pictures.arrays) {
    pictures.arrays->write(job, progress);
  } else {
    for (const std::filesystem::path& file : io::list_unreadable(pictures.paths))
      progress.warn(concat(file.string(),
                           " is left out, for files of its kind cannot be read: convert it to "
                           "JPEG, or set the camera to write JPEG"));
    job.images = io::list_images(pictures.paths);
  }
  job.names = pose::names_of(job.images);
}

/// pose.json. `board` and `masks` may be None.
std::string find_poses(const py::object& photographs, const py::object& out,
                       const py::object& board, bool make_masks, const py::object& masks,
                       bool ordered, const py::dict& given, const py::object& progress) {
  pose::PoseJob job;
  Described described;
  describe_pose(described, job);
  set_options(described, given, "photohull.pose");
  const std::string folder = path_of(out);
  if (folder.empty()) throw UsageError("out: it is empty: give a folder for the scene");
  job.out = std::filesystem::absolute(folder).lexically_normal();
  const bool on_sheet = !board.is_none();
  if (on_sheet) {
    job.board = path_of(board);
    if (job.board.empty())
      throw UsageError("board: it is empty: give the JSON file of a printed sheet");
  } else {
    refuse_options_of_sheet(given);
  }
  if (on_sheet && ordered) throw UsageError("ordered: it is for photographs without a board");
  const Pictures pictures = pictures_of(photographs, masks, on_sheet);
  job.make_masks = make_masks;
  job.ordered = ordered;
  std::string report;
  const double weight = (on_sheet ? kOnSheet : kByColmap) + (pictures.arrays ? kArraysWeight : 0);
  run_job(progress, weight, [&](Progress& to) {
    take(pictures, job, to);
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

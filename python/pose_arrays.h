// Arrays whose cameras are to be found, as files of the scene that is written.
#pragma once

#include <pybind11/pybind11.h>

#include "core/progress.h"
#include "pose/pose_job.h"

namespace photohull::python {

/// The weight of the stage that writes them.
inline constexpr double kArraysWeight = 0.1;

/// A str, bytes or os.PathLike.
bool is_path(const pybind11::handle& value);

/// Is it an array of photographs, or a list that has an array in it?
bool are_arrays(const pybind11::object& photographs);

class PosedArrays {
 public:
  /// `photographs` are as image_of takes them, but uint8 alone; `masks` is None, or has for each a
  /// mask of its size, as mask_of takes them, or None. Throws UsageError for any others.
  PosedArrays(const pybind11::object& photographs, const pybind11::object& masks);

  /// Writes arrays/NUMBER.png and, if there are any, masks/NUMBER.png into the job's folder, and
  /// sets the job's images and folder of masks. For a thread without the interpreter's lock.
  void write(pose::PoseJob& job, Progress& progress) const;

 private:
  pybind11::list photographs_, masks_;  // of masks one for each photograph, or none
};

}  // namespace photohull::python

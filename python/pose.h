// Cameras of photographs on a printed sheet, or found by COLMAP, for Python.
#pragma once

#include <pybind11/pybind11.h>

namespace photohull::python {

void bind_pose(pybind11::module_& module);

}  // namespace photohull::python

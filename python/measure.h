// Measurements of results for Python.
#pragma once

#include <pybind11/pybind11.h>

namespace photohull::python {

void bind_measure(pybind11::module_& module);

}  // namespace photohull::python

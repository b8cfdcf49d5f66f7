// The steps beside reconstruction for Python: masks, evaluation, synthetic photographs, devices.
#pragma once

#include <pybind11/pybind11.h>

namespace photohull::python {

void bind_tools(pybind11::module_& module);

}  // namespace photohull::python

// Masks projected back onto dense arrays, for photohull/romi.py.
#pragma once

#include <pybind11/pybind11.h>

namespace photohull::python {

void bind_romi(pybind11::module_& module);

}  // namespace photohull::python

// Results for Python.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "pipeline/reconstruct.h"

namespace photohull::python {

/// A reconstruction, with the options that it was made by.
struct Result {
  pipeline::ReconstructOptions options;
  pipeline::Reconstruction made;
};

void bind_result(pybind11::module_& module);

}  // namespace photohull::python

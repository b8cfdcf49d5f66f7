// Scenes for Python.
#pragma once

#include <pybind11/pybind11.h>

#include "pipeline/photographs.h"
#include "pipeline/reconstruct_options.h"

namespace photohull::python {

/// Photographs with their cameras, and what was said of their box.
struct Scene {
  pipeline::Photographs photographs;
  pipeline::BoxOptions box;
};

/// Those that photohull.load has.
void describe_scene(Described& to, Scene& scene);

void bind_scene(pybind11::module_& module);

}  // namespace photohull::python

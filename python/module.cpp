// photohull._core: the library as Python's package `photohull` calls it. What users call, with its
// documentation, is written in Python (photohull/__init__.py).
#include <pybind11/pybind11.h>

#include "errors.h"
#include "measure.h"
#include "pose.h"
#include "result.h"
#include "romi.h"
#include "scene.h"
#include "tools.h"

PYBIND11_MODULE(_core, module) {
  using namespace photohull::python;
  translate_errors();
  bind_scene(module);
  bind_result(module);
  bind_measure(module);
  bind_tools(module);
  bind_pose(module);
  bind_romi(module);
  module.attr("version") = PHOTOHULL_VERSION;
}

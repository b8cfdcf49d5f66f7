#include "measure.h"

#include <string>

#include "options.h"
#include "pipeline/measure_result.h"
#include "result.h"

namespace photohull::python {
namespace py = pybind11;
namespace {

MeasureOptions options_of(const py::dict& given) {
  MeasureOptions options;
  Described described;
  describe(described, options);
  set_options(described, given, "photohull.measure");
  return options;
}

py::object parsed(const Measurements& measured) {
  return py::module_::import("json").attr("loads")(pipeline::to_json(measured));
}

py::object measure(const Result& result, const py::dict& given) {
  const MeasureOptions options = options_of(given);
  Measurements measured;
  {
    const py::gil_scoped_release free;
    measured = pipeline::measure(result.made, options);
  }
  return parsed(measured);
}

py::object measure_folder(const py::object& folder, const py::dict& given) {
  const MeasureOptions options = options_of(given);
  const std::string path = path_of(folder);
  Measurements measured;
  {
    const py::gil_scoped_release free;
    measured = pipeline::measure_folder(path, options);
  }
  return parsed(measured);
}

}  // namespace

void bind_measure(py::module_& module) {
  module.def("measure", measure);
  module.def("measure_folder", measure_folder);
  module.def("measure_options", [] {
    MeasureOptions options;
    Described described;
    describe(described, options);
    return option_list(described);
  });
}

}  // namespace photohull::python

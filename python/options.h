// Described options (core/describe.h) as keyword arguments.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "core/describe.h"

namespace photohull::python {

/// Sets the options that `given` names; None leaves one as it is. Throws UsageError for names that
/// there are not and values that are not legal; `function` is what was called.
void set_options(const Described& described, const pybind11::dict& given,
                 const std::string& function);

/// For people and for stubs: a list of dictionaries with name, help, values, default and type, the
/// last as Python writes types.
pybind11::list option_list(const Described& described);

/// The file system's name of a str, bytes or os.PathLike.
std::string path_of(const pybind11::object& path);

}  // namespace photohull::python

// Jobs of the library run for Python: the interpreter stays free meanwhile, and may stop them.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>

#include "core/progress.h"

namespace photohull::python {

/// Does the work in a thread of its own and waits for it without holding the interpreter's lock.
/// Unless it is None, `callback(stage, fraction, message)` is called in the caller's thread, at
/// most twenty times a second: the stage's name, the share of the whole job that is done in [0, 1]
/// (`total_weight` is the sum of its stages' weights; the last call has 1), and a warning or note,
/// or None. When the
/// callback raises, or a signal's handler does (Ctrl-C), the work is cancelled, and after it has
/// stopped that exception goes on. What the work throws comes out as it is.
void run_job(const pybind11::object& callback, double total_weight,
             const std::function<void(Progress&)>& work);

}  // namespace photohull::python

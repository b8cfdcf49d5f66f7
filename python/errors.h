// The library's errors as Python's exceptions.
#pragma once

namespace photohull::python {

/// From here on, Error becomes the class of photohull/_errors.py for its kind.
void translate_errors();

}  // namespace photohull::python

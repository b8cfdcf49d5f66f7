#include "errors.h"

#include <pybind11/pybind11.h>

#include "core/error.h"

namespace photohull::python {
namespace {

const char* class_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kUsage:
      return "UsageError";
    case ErrorKind::kMemory:
      return "OutOfMemory";
    case ErrorKind::kDevice:
      return "DeviceError";
    case ErrorKind::kCancelled:
      return "Cancelled";
    case ErrorKind::kFailed:
    case ErrorKind::kDoubted:
      break;
  }
  return "Error";
}

}  // namespace

void translate_errors() {
  pybind11::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const Error& error) {
      const auto type = pybind11::module_::import("photohull._errors").attr(class_of(error.kind()));
      PyErr_SetString(type.ptr(), error.what());
    }
  });
}

}  // namespace photohull::python

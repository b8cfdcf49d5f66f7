// NumPy's arrays as the library's pixels and matrices, and the library's data as arrays.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "core/box.h"
#include "core/image.h"

namespace photohull::python {

/// A photograph: (height, width), or (height, width, channels) with 1 channel of grey, 3 of RGB or
/// 4 of RGBA, in any order of memory. uint8 and uint16 are sRGB, float32 and float64 linear light.
/// Throws UsageError opening with `where` for any other shape or type, and values that are not
/// finite.
ColourImage image_of(const pybind11::handle& value, const std::string& where);

/// Coverage: (height, width) of bool, uint8 from 0 to 255, or floating-point numbers from 0 to 1.
/// None is no mask. Throws UsageError opening with `where`.
Mask mask_of(const pybind11::handle& value, const std::string& where);

/// Numbers of one of the shapes; -1 stands for any length. Throws UsageError opening with `where`,
/// also for numbers that are not finite.
pybind11::array_t<double> numbers_of(const pybind11::handle& value,
                                     const std::vector<std::vector<int>>& shapes,
                                     const std::string& where);

/// Two corners, (2, 3) or six numbers.
Box box_of(const pybind11::handle& value, const std::string& where);

/// An array over memory that `owner` keeps; it cannot be written to.
template <typename Element>
pybind11::array view_of(const Element* data, std::vector<pybind11::ssize_t> shape,
                        const pybind11::object& owner) {
  pybind11::array_t<Element> array(std::move(shape), data, owner);
  pybind11::detail::array_proxy(array.ptr())->flags &=
      ~pybind11::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// A new (height, width[, channels]) array of the bytes.
pybind11::array_t<std::uint8_t> bytes_array(const std::vector<std::uint8_t>& bytes, int width,
                                            int height, int channels);
pybind11::array_t<double> matrix_array(const glm::dmat3& matrix);
pybind11::array_t<double> vector_array(const glm::dvec3& vector);
pybind11::array_t<double> box_array(const Box& box);

}  // namespace photohull::python
